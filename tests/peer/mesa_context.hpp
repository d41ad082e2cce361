// OpenGL ES 3 by Mesa's llvmpipe, off screen through EGL without a window system.
#pragma once

#include <memory>
#include <string>

namespace halflit::peer {

/// The context is current in the thread that made it, until it is destroyed.
class MesaContext {
public:
    /// Null with a reason when this machine has no software OpenGL ES 3 by llvmpipe.
    static std::unique_ptr<MesaContext> create(std::string& reason);
    ~MesaContext();
    MesaContext(const MesaContext&) = delete;
    MesaContext& operator=(const MesaContext&) = delete;

    [[nodiscard]] const std::string& renderer() const { return renderer_; }

private:
    MesaContext() = default;
    void* display_ = nullptr;
    void* context_ = nullptr;
    std::string renderer_;
};

}  // namespace halflit::peer
