/* Before a program's source: what halflit_choose_picture() gives has none of what the frozen header lacks. */
#include <halflit/halflit.h>

static int32_t choose_without_contact_shadow(const halflit_scene* scene, const halflit_picture_request* request, int32_t size[2],
                                             halflit_camera* camera, halflit_settings* settings, halflit_lighting** lighting) {
    const int32_t result = halflit_choose_picture(scene, request, size, camera, settings, lighting);
    settings->contact_shadow = 0;
    settings->alpha = HALFLIT_ALPHA_SPACE_LINEAR;
    settings->shadow_softness_deg = 0;
    settings->edl = HALFLIT_EDL_OFF;
    settings->edge_contrast = 0;
    return result;
}
#define halflit_choose_picture choose_without_contact_shadow
