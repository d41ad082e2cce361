// A file in, a picture out
// The shortest useful program: load, choose a view and light, render, write.   halflit_first_picture MODEL.glb OUT.png
#include <halflit/auto_setup.hpp>
#include <halflit/image.hpp>
#include <halflit/model.hpp>
#include <halflit/renderer.hpp>

#include <cstdio>

namespace {

halflit::Result<void> render_file(const char* model, const char* output) {
    using namespace halflit;
    auto loaded = load_model(model);
    if (!loaded) return tl::unexpected(loaded.error());

    PictureRequest request;
    request.size = {640, 480};
    const auto picture = choose_picture(loaded->scene, request);  // view, light and exposure
    if (!picture) return tl::unexpected(picture.error());
    Image image = Image::make(picture->size);
    const auto report = render(loaded->scene, picture->light, picture->camera, picture->settings, image.target());
    if (!report) return tl::unexpected(report.error());
    return write_image(output, image);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: %s MODEL.glb OUT.png\n", argv[0]);
        return static_cast<int>(halflit::ErrorCode::usage);
    }
    const auto done = render_file(argv[1], argv[2]);
    if (done) return 0;
    std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return static_cast<int>(done.error().code);
}
