// All of halflit: the renderer, glTF files and pictures. A program that needs less includes less.
#pragma once

#include "halflit/auto_setup.hpp"
#include "halflit/camera.hpp"
#include "halflit/environment.hpp"
#include "halflit/error.hpp"
#include "halflit/explain.hpp"
#include "halflit/export.hpp"
#include "halflit/gltf.hpp"
#include "halflit/image.hpp"
#include "halflit/isa.hpp"
#include "halflit/light.hpp"
#include "halflit/lobe.hpp"
#include "halflit/material.hpp"
#include "halflit/math.hpp"
#include "halflit/mesh.hpp"
#include "halflit/model.hpp"
#include "halflit/prepared_scene.hpp"
#include "halflit/renderer.hpp"
#include "halflit/report.hpp"
#include "halflit/scene.hpp"
#include "halflit/settings.hpp"
#include "halflit/shading.hpp"
#include "halflit/shapes.hpp"
#include "halflit/target.hpp"
#include "halflit/texture.hpp"
#include "halflit/up_axis.hpp"
#include "halflit/version.hpp"

/// The public interface. Namespaces inside it belong to the library, and change without notice.
namespace halflit {}
