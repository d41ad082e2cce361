"""pyrender's interface (version 0.1.45) over halflit: scripts draw without OpenGL, EGL, OSMesa and a display.

    import halflit.compat.pyrender as pyrender      # in place of import pyrender

Scene, Node, Mesh, Primitive, materials, textures, cameras, lights, OffscreenRenderer and RenderFlags have the names, arguments and defaults
of pyrender, and pictures its conventions: depth is the distance along the camera's axis, 0 where nothing is; colours are light to the power
of 1 / 2.2, without an exposure; lights are in candela and lux. Packages that import pyrender themselves find this one after
sys.modules["pyrender"] = pyrender.

trimesh need not be installed: Mesh.from_trimesh() and Scene.from_trimesh_scene() use what the objects offer.

What differs:
    Viewer, Renderer: there is no window, and no context of OpenGL; both say so. Shaders are not run: of a script's own
        (OffscreenRenderer._renderer._program_cache) those that show normals are known, and others are refused. Normals of back faces that
        are drawn point to the camera.
    Shading: highlights are GGX, with the light that microfacets reflect several times: dielectrics are as bright as in pyrender, the grey
        of meshes without a material is 1.13 times as bright, and a metal of roughness 1 is 2.4 times. Under ambient light alone colours
        are pyrender's; beside lights, it has highlights. Vertex colours are factors on the base colour, not on highlights. Occlusion
        textures darken ambient light alone. Back faces that are drawn are lit from their side.
    Light: all lights shine, not the nearest four of each type. A SHADOWS_ flag of one of the scene's lights lets all lights cast
        shadows, point lights too. An emissive factor counts once.
    alphaMode "MASK" cuts out by alphaCutoff. What blends is sorted by triangles, and blends in linear light.
    Depth is that of the pixel's middle; with an orthographic camera it is a distance too. DEPTH_ONLY and SEG pictures have back faces
        where doubleSided or SKIP_CULL_FACES says so.
    SEG has no smooth edges. VERTEX_NORMALS and FACE_NORMALS are drawn, in the colours alone. Wireframes have the edges of back faces.
    Points and lines without normals show their colours as they are. Triangles without normals are flat.
    A camera's pose may have one scale; a pose or a projection that mirrors or shears is refused.
    Arrays that are set anew are uploaded again. A texture of RGB has an alpha of 1. SpecularGlossinessMaterial is drawn, without its
        specularGlossinessTexture.
"""
from . import camera, constants, image, light, material, mesh, node, offscreen, primitive, renderer, sampler, scene, shader_program
from . import texture, utils, version, viewer
from .camera import Camera, IntrinsicsCamera, OrthographicCamera, PerspectiveCamera
from .constants import GLTF, RenderFlags, TextAlign
from .light import DirectionalLight, Light, PointLight, SpotLight
from .material import Material, MetallicRoughnessMaterial, SpecularGlossinessMaterial
from .mesh import Mesh
from .node import Node
from .offscreen import OffscreenRenderer
from .primitive import Primitive
from .sampler import Sampler
from .scene import Scene
from .texture import Texture
from .version import __version__
from .viewer import Renderer, Viewer

__all__ = [
    *("Camera", "PerspectiveCamera", "OrthographicCamera", "IntrinsicsCamera", "Light", "PointLight", "DirectionalLight", "SpotLight"),
    *("Sampler", "Texture", "Material", "MetallicRoughnessMaterial", "SpecularGlossinessMaterial", "Primitive", "Mesh", "Node", "Scene"),
    *("Renderer", "Viewer", "OffscreenRenderer", "RenderFlags", "TextAlign", "GLTF", "__version__"),
    *("camera", "constants", "image", "light", "material", "mesh", "node", "offscreen", "primitive", "renderer", "sampler", "scene"),
    *("shader_program", "texture", "utils", "version", "viewer"),
]
