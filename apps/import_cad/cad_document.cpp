#include "apps/import_cad/cad_document.hpp"

#include <BinTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepGProp.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepMesh_Context.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <GProp_GProps.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
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
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <cmath>
#include <istream>
#include <map>
#include <utility>

namespace halflit::cad {
namespace {

/// Largest angle between the normals of neighbouring vertices. On spheres, cylinders and cones normals between them are exact.
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

/// A warning for entities that are damaged, or of which no shape can be made.
void warn_of_faults(const Handle(XSControl_WorkSession) & session, std::vector<std::string>& warnings) {
    int count = 0;
    std::string first;
    const auto add = [&](Interface_CheckIterator faults) {
        for (; faults.More(); faults.Next()) {
            if (!faults.Value()->HasFailed()) continue;
            if (count++ == 0) first = std::to_string(faults.Number()) + ": " + faults.Value()->CFail(1);
        }
    };
    add(session->ModelCheckList(false));
    add(session->TransferReader()->TransientProcess()->CheckList(true));
    if (count > 0) warnings.push_back(std::to_string(count) + " entities cannot be read, the first is number " + first);
}

template <class Reader>
void transfer(Reader& reader, const Handle(XSControl_WorkSession) & session, Handle(TDocStd_Document) & document,
              IFSelect_ReturnStatus read, std::vector<std::string>& warnings) {
    if (read != IFSelect_RetDone) throw Refused("cannot be read to its end, or is not well-formed");
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetLayerMode(false);
    if (!reader.Transfer(document)) throw Refused("holds no shape that can be read");
    warn_of_faults(session, warnings);
}

Handle(TDocStd_Document) read_shapes(const std::string& bytes, Format format, std::vector<std::string>& warnings) {
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    if (format == Format::step) {
        STEPCAFControl_Reader reader;
        Interface_Static::SetCVal("xstep.cascade.unit", "MM");
        Standard_ArrayStreamBuffer buffer(bytes.data(), bytes.size());
        std::istream stream(&buffer);
        const IFSelect_ReturnStatus read = reader.ChangeReader().ReadStream("model", stream);
        transfer(reader, reader.ChangeReader().WS(), document, read, warnings);
    } else if (format == Format::iges) {
        IGESCAFControl_Reader reader;
        Interface_Static::SetCVal("xstep.cascade.unit", "MM");
        const IFSelect_ReturnStatus read = reader.ReadFile(kStandardInput);
        transfer(reader, reader.WS(), document, read, warnings);
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

bool is_number(std::string_view text) { return text.find_first_not_of("0123456789") == std::string_view::npos; }

/// The names of kinds that programs give to shapes without one, with or without a number.
bool is_made_up(std::string_view name) {
    static constexpr std::string_view kKinds[] = {"COMPOUND", "COMPSOLID", "SOLID", "SHELL", "FACE",    "WIRE",
                                                  "EDGE",     "VERTEX",    "SHAPE", "NAUO",  "ASSEMBLY"};
    return name.empty() || name.substr(0, 2) == "=>" || std::any_of(std::begin(kKinds), std::end(kKinds), [&](std::string_view kind) {
               return name.substr(0, kind.size()) == kind && is_number(name.substr(kind.size()));
           });
}

/// That of its place in the assembly, which may be a mere number, or of its part.
std::string name_of(const XCAFPrs_DocumentNode& node) {
    const std::string own = utf8_of(node.Label), part = utf8_of(node.RefLabel);
    if (!is_made_up(own) && (!is_number(own) || is_made_up(part))) return own;
    return is_made_up(part) ? std::string() : part;
}

IMeshTools_Parameters mesh_parameters(double deflection) {
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection;
    parameters.Angle = kAngleRad;
    return parameters;
}

bool has_triangles(const TopoDS_Face& face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
    return !triangles.IsNull() && triangles->NbTriangles() > 0;
}

/// Gives a face the triangles of its surface as NURBS, for faces that the mesher fails at, such as some cones. False: it fails again.
bool mesh_as_nurbs(const TopoDS_Face& face, double deflection) {
    const TopoDS_Shape converted = BRepBuilderAPI_NurbsConvert(face, true).Shape();
    BRepMesh_IncrementalMesh(converted, mesh_parameters(deflection));
    TopExp_Explorer one(converted, TopAbs_FACE);
    if (!one.More() || !has_triangles(TopoDS::Face(one.Current()))) return false;
    const TopoDS_Face& made = TopoDS::Face(one.Current());
    TopLoc_Location there, here;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(made, there)->Copy();
    (void)BRep_Tool::Surface(face, here);
    const gp_Trsf move = here.Transformation().Inverted() * there.Transformation();
    triangles->AddNormals();
    BRepAdaptor_Surface surface(made, false);
    for (int i = 1; i <= triangles->NbNodes(); ++i) {
        const gp_Pnt2d uv = triangles->UVNode(i);
        BRepLProp_SLProps at(surface, uv.X(), uv.Y(), 2, Precision::Confusion());
        const gp_Dir normal = at.IsNormalDefined() ? at.Normal() : gp_Dir(0, 0, 1);
        triangles->SetNormal(i, normal.Transformed(here.Transformation().Inverted()));
        triangles->SetNode(i, triangles->Node(i).Transformed(move));
    }
    BRep_Builder().UpdateFace(face, triangles);
    return true;
}

/// False: faces lack triangles.
bool mesh(const TopoDS_Shape& shape, double deflection) {
    BRepMesh_IncrementalMesh mesher;
    mesher.SetShape(shape);
    mesher.ChangeParameters() = mesh_parameters(deflection);
    // The time of the usual algorithm grows by the square of a face's vertices.
    mesher.Perform(new BRepMesh_Context(IMeshTools_MeshAlgoType_Delabella));
    bool is_whole = true;
    for (TopExp_Explorer one(shape, TopAbs_FACE); one.More(); one.Next())
        if (const TopoDS_Face& face = TopoDS::Face(one.Current()); !has_triangles(face))
            is_whole = mesh_as_nurbs(face, deflection) && is_whole;
    return is_whole;
}

/// Diagonal of the box of all triangles, or of surfaces that have none yet.
double diagonal_of(const std::vector<std::pair<TopoDS_Shape, TopLoc_Location>>& placed) {
    Bnd_Box box;
    for (const auto& [shape, location] : placed) {
        Bnd_Box one;
        BRepBndLib::Add(shape.Moved(location, false), one);
        if (!one.IsVoid() && !one.IsOpen()) box.Add(one);
    }
    return box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
}

/// Area and volume of a shape.
Measures measures_of(const TopoDS_Shape& shape) {
    constexpr double kRelativeError = 1e-6;
    Measures found{};
    GProp_GProps surface;
    BRepGProp::SurfaceProperties(shape, surface, kRelativeError);
    found.area = surface.Mass();
    for (TopExp_Explorer one(shape, TopAbs_SOLID); one.More(); one.Next(), ++found.solids) {
        GProp_GProps solid;
        BRepGProp::VolumeProperties(one.Current(), solid, kRelativeError);
        found.volume += solid.Mass();
    }
    return found;
}

void set_box(const TopoDS_Shape& placed, Measures& measures) {
    Bnd_Box box;
    BRepBndLib::AddOptimal(placed, box, false, false);
    if (box.IsVoid()) return;
    std::array<double, 6>& m = measures.box;
    box.Get(m[0], m[1], m[2], m[3], m[4], m[5]);
    for (double& x : m)
        if (std::abs(x) <= Precision::Confusion()) x = 0;
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

constexpr std::array<float, 4> kNoColor = {-1, -1, -1, -1};

std::array<float, 4> linear_of(const Quantity_ColorRGBA& color) {
    const Quantity_Color& rgb = color.GetRGB();
    return {static_cast<float>(rgb.Red()), static_cast<float>(rgb.Green()), static_cast<float>(rgb.Blue()), color.Alpha()};
}

Shape shape_of(const XCAFPrs_DocumentNode& node) {
    Shape shape{utf8_of(node.RefLabel), {}};
    if (is_made_up(shape.name)) shape.name.clear();
    TopTools_IndexedMapOfShape numbers;
    TopExp::MapShapes(shape_at(node), TopAbs_FACE, numbers);
    std::map<std::array<float, 4>, std::size_t> patch_of_color;
    for (RWMesh_FaceIterator face(node.RefLabel, TopLoc_Location(), true, node.Style); face.More(); face.Next()) {
        if (face.IsEmptyMesh() || !face.FaceStyle().IsVisible()) continue;
        const std::array<float, 4> color = face.HasFaceColor() ? linear_of(face.FaceColor()) : kNoColor;
        const auto [found, is_new] = patch_of_color.try_emplace(color, shape.patches.size());
        if (is_new) shape.patches.emplace_back();
        Patch& patch = shape.patches[found->second];
        if (color != kNoColor) patch.color = color;
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
    Document out;
    const Handle(TDocStd_Document) document = read_shapes(bytes, format, out.warnings);
    std::vector<XCAFPrs_DocumentNode> leaves;  // of out.shapes
    std::vector<std::pair<TopoDS_Shape, TopLoc_Location>> placed;
    std::vector<int> placed_nodes;
    std::map<std::pair<std::string, std::array<float, 4>>, int> shape_of_key;
    std::vector<int> above;  // node of each depth
    for (XCAFPrs_DocumentExplorer walk(document, XCAFPrs_DocumentExplorerFlags_None); walk.More(); walk.Next()) {
        const XCAFPrs_DocumentNode& node = walk.Current();
        const auto depth = static_cast<std::size_t>(walk.CurrentDepth());
        above.resize(depth, -1);
        Node made{name_of(node), depth == 0 ? -1 : above[depth - 1], -1, node.LocalTrsf};
        if (!node.Style.IsVisible() && !node.IsAssembly) continue;
        above.push_back(static_cast<int>(out.nodes.size()));
        if (!node.IsAssembly) {
            if (made.name.empty() && made.parent >= 0) made.name = out.nodes[static_cast<std::size_t>(made.parent)].name;
            TCollection_AsciiString entry;
            TDF_Tool::Entry(node.RefLabel, entry);
            const std::array<float, 4> color = node.Style.IsSetColorSurf() ? linear_of(node.Style.GetColorSurfRGBA()) : kNoColor;
            const auto [found, is_new] = shape_of_key.try_emplace({entry.ToCString(), color}, static_cast<int>(leaves.size()));
            if (is_new) leaves.push_back(node);
            made.shape = found->second;
            placed.emplace_back(shape_at(node), node.Location);
            placed_nodes.push_back(static_cast<int>(out.nodes.size()));
        }
        out.nodes.push_back(std::move(made));
    }
    // The box of the surfaces' poles may be much larger than that of the triangles. A power of the square root of 2, so that a part that is
    // added seldom changes the triangles of the others.
    constexpr double kSame = 0.9;
    double deflection_mm = 0.0;
    bool is_whole = true;
    for (double loose = diagonal_of(placed), tight = 0.0;; loose = tight) {
        const double most = std::max(kDeflectionPx * loose / pixels, Precision::Confusion());
        deflection_mm = std::ldexp(1.0, std::ilogb(most));
        if (deflection_mm * M_SQRT2 <= most) deflection_mm *= M_SQRT2;
        is_whole = true;
        for (const XCAFPrs_DocumentNode& leaf : leaves) is_whole = mesh(shape_at(leaf), deflection_mm) && is_whole;
        tight = diagonal_of(placed);
        if (tight >= kSame * loose) break;
    }
    if (!is_whole) out.warnings.emplace_back("faces are left out of which no triangles can be made");
    bool is_empty = true;
    for (const XCAFPrs_DocumentNode& leaf : leaves) {
        out.shapes.push_back(shape_of(leaf));
        is_empty = is_empty && out.shapes.back().patches.empty();
    }
    for (std::size_t i = 0; is_empty && i < leaves.size(); ++i)  // lines beside faces are axes and other helps
        if (Patch lines = lines_of(leaves[i], deflection_mm); !lines.indices.empty()) out.shapes[i].patches.push_back(std::move(lines));
    if (std::all_of(out.shapes.begin(), out.shapes.end(), [](const Shape& shape) { return shape.patches.empty(); }))
        throw Refused("holds no faces and no edges; parts of an assembly that lie in other files are not read");
    if (!measure) return out;
    std::vector<Measures> of_leaf;
    for (const XCAFPrs_DocumentNode& leaf : leaves) of_leaf.push_back(measures_of(shape_at(leaf)));
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const auto node = static_cast<std::size_t>(placed_nodes[i]);
        Measures there = of_leaf[static_cast<std::size_t>(out.nodes[node].shape)];
        there.node = placed_nodes[i];
        set_box(placed[i].first.Moved(placed[i].second, false), there);
        out.measures.push_back(there);
    }
    return out;
}

}  // namespace halflit::cad
