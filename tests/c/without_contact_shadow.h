/* Before a program's source: what halflit_choose_picture() gives has no contact shadow. */
#include <halflit/halflit.h>

static int32_t choose_without_contact_shadow(const halflit_scene* scene, const halflit_picture_request* request, int32_t size[2],
                                             halflit_camera* camera, halflit_settings* settings, halflit_lighting** lighting) {
    const int32_t result = halflit_choose_picture(scene, request, size, camera, settings, lighting);
    settings->contact_shadow = 0;
    return result;
}
#define halflit_choose_picture choose_without_contact_shadow
