#include "apps/import_cad/cad_document.hpp"

#include <BinTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_Context.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <GProp_GProps.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <RWMesh_FaceIterator.hxx>
#include <Standard_ArrayStreamBuffer.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDataStd_Name.hxx>
#include <TDF_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>

#include <algorithm>
#include <cmath>
#include <istream>
#include <map>
#include <utility>

namespace halflit::cad {
namespace {

/// Largest angle between normals of neighbouring vertices. Normals between them are off by its third power: 3e-4, which changes light by
/// less than a tenth of a code.
constexpr double kAngleRad = 0.2;
/// A quarter of a pixel, less what the mesher exceeds it by (5 %), and what the box may be too large by (a ninth).
constexpr double kDeflectionPx = 0.21;

constexpr std::string_view kBinaryBrep = "Open CASCADE Topology";

/// Name of standard input as a file: IGES is read from files alone.
constexpr const char* kStandardInput = "/dev/stdin";

constexpr std::pair<std::string_view, Format> kBegins[] = {
    {"ISO-10303-21", Format::step}, {"DBRep_DrawableShape", Format::brep}, {"CASCADE Topology", Format::brep}, {kBinaryBrep, Format::brep}};

TopoDS_Shape read_brep(const std::string& bytes) try {
    Standard_ArrayStreamBuffer buffer(bytes.data(), bytes.size());
    std::istream stream(&buffer);
    stream.exceptions(std::ios::failbit | std::ios::badbit);  // the library would read on for ever
    TopoDS_Shape shape;
    if (std::string_view(bytes).substr(0, 64).find(kBinaryBrep) != std::string_view::npos) {
        BinTools::Read(shape, stream);
    } else {
        BRepTools::Read(shape, stream, BRep_Builder());
    }
    if (shape.IsNull()) throw Refused("holds no shape that can be read");
    return shape;
} catch (const std::ios::failure&) {
    throw Refused("cannot be read to its end, or is not well-formed");
}

template <class Reader>
void transfer(Reader& reader, Handle(TDocStd_Document) & document, IFSelect_ReturnStatus read) {
    if (read != IFSelect_RetDone) throw Refused("cannot be read to its end, or is not well-formed");
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetLayerMode(false);
    if (!reader.Transfer(document)) throw Refused("holds no shape that can be read");
}

Handle(TDocStd_Document) read_shapes(const std::string& bytes, Format format) {
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    if (format == Format::step) {
        STEPCAFControl_Reader reader;
        Interface_Static::SetCVal("xstep.cascade.unit", "MM");
        Standard_ArrayStreamBuffer buffer(bytes.data(), bytes.size());
        std::istream stream(&buffer);
        transfer(reader, document, reader.ChangeReader().ReadStream("model", stream));
    } else if (format == Format::iges) {
        IGESCAFControl_Reader reader;
        Interface_Static::SetCVal("xstep.cascade.unit", "MM");
        transfer(reader, document, reader.ReadFile(kStandardInput));
    } else {
        XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(read_brep(bytes), false);
    }
    return document;
}

std::string utf8_of(const TDF_Label& label) {
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
    const TCollection_ExtendedString& wide = name->Get();
    std::string text(static_cast<std::size_t>(wide.LengthOfCString()) + 1, '\0');
    Standard_PCharacter begin = text.data();
    text.resize(static_cast<std::size_t>(wide.ToUTF8CString(begin)));
    return text;
}

/// Names that programs give to parts and shapes without one: numbers, kinds of shapes.
bool is_made_up(std::string name) {
    if (name.rfind("NAUO", 0) == 0) name.erase(0, 4);
    if (name.find_first_not_of("0123456789") == std::string::npos) return true;
    static constexpr const char* kKinds[] = {"COMPOUND", "COMPSOLID", "SOLID", "SHELL",    "FACE", "WIRE",
                                             "EDGE",     "VERTEX",    "SHAPE", "ASSEMBLY", "=>"};
    return std::any_of(std::begin(kKinds), std::end(kKinds), [&](const char* kind) { return name.rfind(kind, 0) == 0; }) &&
           name.find_first_of(" _") == std::string::npos;
}

std::string name_of(const XCAFPrs_DocumentNode& node) {
    for (const TDF_Label& label : {node.Label, node.RefLabel})
        if (std::string name = utf8_of(label); !name.empty() && !is_made_up(name)) return name;
    return {};
}

void mesh(const TopoDS_Shape& shape, double deflection) {
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection;
    parameters.Angle = kAngleRad;
    BRepMesh_IncrementalMesh mesher;
    mesher.SetShape(shape);
    mesher.ChangeParameters() = parameters;
    // The other algorithm's time grows by the square of a face's vertices.
    mesher.Perform(new BRepMesh_Context(IMeshTools_MeshAlgoType_Delabella));
}

/// Diagonal of the box of all triangles that the nodes place.
double diagonal_of(const std::vector<std::pair<TopoDS_Shape, TopLoc_Location>>& placed) {
    Bnd_Box box;
    for (const auto& [shape, location] : placed) {
        Bnd_Box one;
        BRepBndLib::Add(shape, one);
        if (one.IsVoid() || one.IsOpen()) continue;
        box.Add(one.Transformed(location.Transformation()));
    }
    return box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
}

std::array<double, 8> measures_of(const std::vector<std::pair<TopoDS_Shape, TopLoc_Location>>& placed) {
    constexpr double kRelativeError = 1e-6;
    Bnd_Box box;
    double area = 0, volume = 0;
    for (const auto& [shape, location] : placed) {
        const TopoDS_Shape there = shape.Moved(location);
        BRepBndLib::AddOptimal(there, box, false, false);
        GProp_GProps surface;
        BRepGProp::SurfaceProperties(there, surface, kRelativeError);
        area += surface.Mass();
        for (TopExp_Explorer one(there, TopAbs_SOLID); one.More(); one.Next()) {
            GProp_GProps solid;
            BRepGProp::VolumeProperties(one.Current(), solid, kRelativeError);
            volume += solid.Mass();
        }
    }
    std::array<double, 8> m{0, 0, 0, 0, 0, 0, area, volume};
    if (!box.IsVoid()) box.Get(m[0], m[1], m[2], m[3], m[4], m[5]);
    for (double& x : m)
        if (std::abs(x) <= Precision::Confusion()) x = 0;
    return m;
}

TopoDS_Shape shape_at(const XCAFPrs_DocumentNode& node) { return XCAFDoc_ShapeTool::GetShape(node.RefLabel); }

/// Normals that are opposite to those of the triangles around them, as they may be at poles, where the surface's derivatives vanish.
/// Vertices and indices from these on count.
void face_outwards(Patch& patch, std::uint32_t first, std::size_t first_index) {
    const auto vector = [&](const std::vector<float>& values, std::uint32_t i) {
        return gp_XYZ(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    };
    std::vector<gp_XYZ> around(patch.positions.size() / 3 - first);
    for (std::size_t i = first_index; i < patch.indices.size(); i += 3) {
        const std::uint32_t* const corner = &patch.indices[i];
        const gp_XYZ a = vector(patch.positions, corner[0]);
        const gp_XYZ area = (vector(patch.positions, corner[1]) - a).Crossed(vector(patch.positions, corner[2]) - a);
        for (int k = 0; k < 3; ++k) around[corner[k] - first] += area;
    }
    for (std::uint32_t i = 0; i < around.size(); ++i) {
        if (around[i].Dot(vector(patch.normals, first + i)) >= 0) continue;
        for (std::size_t k = 0; k < 3; ++k) patch.normals[3 * (first + i) + k] *= -1;
    }
}

/// Edges that no face has, as of wire frames.
Patch lines_of(const XCAFPrs_DocumentNode& node, double deflection) {
    Patch lines;
    lines.is_lines = true;
    if (node.Style.IsSetColorCurv()) {
        const Quantity_Color& told = node.Style.GetColorCurv();
        lines.color = {static_cast<float>(told.Red()), static_cast<float>(told.Green()), static_cast<float>(told.Blue()), 1.0f};
    }
    for (TopExp_Explorer one(shape_at(node), TopAbs_EDGE, TopAbs_FACE); one.More(); one.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(one.Current());
        if (BRep_Tool::Degenerated(edge) || !BRep_Tool::IsGeometric(edge)) continue;
        const BRepAdaptor_Curve curve(edge);
        if (Precision::IsInfinite(curve.FirstParameter()) || Precision::IsInfinite(curve.LastParameter())) continue;
        const GCPnts_TangentialDeflection points(curve, kAngleRad, deflection);
        for (int i = 1; i <= points.NbPoints(); ++i) {
            const auto vertex = static_cast<std::uint32_t>(lines.positions.size() / 3);
            if (i > 1) lines.indices.insert(lines.indices.end(), {vertex - 1, vertex});
            const gp_Pnt p = points.Value(i);
            for (int k = 1; k <= 3; ++k) lines.positions.push_back(static_cast<float>(p.Coord(k)));
        }
    }
    return lines;
}

Shape shape_of(const XCAFPrs_DocumentNode& node, double deflection) {
    Shape shape{utf8_of(node.RefLabel), {}};
    if (is_made_up(shape.name)) shape.name.clear();
    TopTools_IndexedMapOfShape numbers;
    TopExp::MapShapes(shape_at(node), TopAbs_FACE, numbers);
    std::map<std::array<float, 4>, std::size_t> patch_of_color;
    constexpr std::array<float, 4> kNone = {-1, -1, -1, -1};
    for (RWMesh_FaceIterator face(node.RefLabel, TopLoc_Location(), true, node.Style); face.More(); face.Next()) {
        if (face.IsEmptyMesh() || !face.FaceStyle().IsVisible()) continue;
        std::array<float, 4> color = kNone;
        if (face.HasFaceColor()) {
            const Quantity_ColorRGBA& told = face.FaceColor();
            color = {static_cast<float>(told.GetRGB().Red()), static_cast<float>(told.GetRGB().Green()),
                     static_cast<float>(told.GetRGB().Blue()), told.Alpha()};
        }
        const auto [found, is_new] = patch_of_color.try_emplace(color, shape.patches.size());
        if (is_new) shape.patches.emplace_back();
        Patch& patch = shape.patches[found->second];
        if (color != kNone) patch.color = color;
        const auto first = static_cast<std::uint32_t>(patch.positions.size() / 3);
        const auto number = static_cast<float>(numbers.FindIndex(face.Face()) - 1);
        for (int i = face.NodeLower(); i <= face.NodeUpper(); ++i) {
            const gp_Pnt p = face.NodeTransformed(i);
            const gp_Dir n = face.NormalTransformed(i);
            for (int k = 1; k <= 3; ++k) {
                patch.positions.push_back(static_cast<float>(p.Coord(k)));
                patch.normals.push_back(static_cast<float>(n.Coord(k)));
            }
            patch.faces.push_back(number);
        }
        const std::size_t first_index = patch.indices.size();
        for (int i = face.ElemLower(); i <= face.ElemUpper(); ++i) {
            const Poly_Triangle triangle = face.TriangleOriented(i);
            for (int k = 1; k <= 3; ++k) patch.indices.push_back(first + static_cast<std::uint32_t>(triangle(k) - face.NodeLower()));
        }
        face_outwards(patch, first, first_index);
    }
    if (Patch lines = lines_of(node, deflection); !lines.indices.empty()) shape.patches.push_back(std::move(lines));
    return shape;
}

}  // namespace

std::optional<Format> find_format(std::string_view bytes) {
    constexpr std::size_t kBlanks = 8, kIgesMark = 72;  // line breaks and marks in front; column of the section's letter
    for (const auto& [mark, format] : kBegins)
        if (bytes.substr(0, mark.size() + kBlanks).find(mark) != std::string_view::npos) return format;
    return bytes.size() > kIgesMark && bytes[kIgesMark] == 'S' ? std::optional(Format::iges) : std::nullopt;
}

Document read_document(const std::string& bytes, Format format, double pixels, bool measure) {
    const Handle(TDocStd_Document) document = read_shapes(bytes, format);
    Document out;
    std::vector<XCAFPrs_DocumentNode> leaves;  // of out.shapes
    std::vector<std::pair<TopoDS_Shape, TopLoc_Location>> placed;
    std::map<std::string, int> shape_of_key;
    std::vector<int> above;  // node of each depth
    for (XCAFPrs_DocumentExplorer walk(document, XCAFPrs_DocumentExplorerFlags_None); walk.More(); walk.Next()) {
        const XCAFPrs_DocumentNode& node = walk.Current();
        const auto depth = static_cast<std::size_t>(walk.CurrentDepth());
        above.resize(depth, -1);
        Node made{name_of(node), depth == 0 ? -1 : above[depth - 1], -1, node.LocalTrsf};
        if (!node.Style.IsVisible() && !node.IsAssembly) continue;
        above.push_back(static_cast<int>(out.nodes.size()));
        if (!node.IsAssembly) {
            TCollection_AsciiString entry;
            TDF_Tool::Entry(node.RefLabel, entry);
            std::string key = entry.ToCString();
            if (node.Style.IsSetColorSurf()) key += ' ' + std::to_string(XCAFPrs_Style::HashCode(node.Style, INT_MAX));
            const auto [found, is_new] = shape_of_key.try_emplace(std::move(key), static_cast<int>(leaves.size()));
            if (is_new) leaves.push_back(node);
            made.shape = found->second;
            placed.emplace_back(shape_at(node), node.Location);
        }
        out.nodes.push_back(std::move(made));
    }
    // The box of the surfaces' poles may be much larger than that of the triangles.
    constexpr double kSame = 0.9;
    double deflection_mm = 0.0;
    for (double loose = diagonal_of(placed), tight = 0.0;; loose = tight) {
        deflection_mm = std::max(kDeflectionPx * loose / pixels, Precision::Confusion());
        for (const XCAFPrs_DocumentNode& leaf : leaves) mesh(shape_at(leaf), deflection_mm);
        tight = diagonal_of(placed);
        if (tight >= kSame * loose) break;
    }
    bool is_empty = true;
    for (const XCAFPrs_DocumentNode& leaf : leaves) {
        out.shapes.push_back(shape_of(leaf, deflection_mm));
        is_empty = is_empty && out.shapes.back().patches.empty();
    }
    if (is_empty) throw Refused("holds no faces and no edges; parts of an assembly that lie in other files are not read");
    if (measure) out.measures = measures_of(placed);
    return out;
}

}  // namespace halflit::cad
