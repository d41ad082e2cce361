#include "apps/import_cad/cad_document.hpp"

#include <BRepBndLib.hxx>
#include <BRepMesh_Context.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <RWMesh_FaceIterator.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_ArrayStreamBuffer.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>

#include <algorithm>
#include <istream>
#include <map>
#include <utility>

namespace halflit::cad {
namespace {

/// Largest angle between normals of neighbouring vertices. Normals between them are off by its third power: 3e-4, which changes light by
/// less than a tenth of a code.
constexpr double kAngleRad = 0.2;
constexpr double kDeflectionPx = 0.25;

/// Name of standard input as a file: IGES is read from files alone.
constexpr const char* kStandardInput = "/dev/stdin";

struct Begin {
    Format format;
    std::string_view mark;
    std::size_t offset;
};
constexpr Begin kBegins[] = {
    {Format::step, "ISO-10303-21", 0},         {Format::brep, "DBRep_DrawableShape", 0}, {Format::brep, "CASCADE Topology", 0},
    {Format::brep, "Open CASCADE Topology", 0}, {Format::iges, "S      1", 72},
};
constexpr const char* kNames[] = {"STEP", "IGES", "BREP"};

TopoDS_Shape read_brep(const std::string& bytes) {
    Standard_ArrayStreamBuffer buffer(bytes.data(), bytes.size());
    std::istream stream(&buffer);
    TopoDS_Shape shape;
    if (std::string_view(bytes).substr(0, 64).find("Open CASCADE Topology") != std::string_view::npos) {
        BinTools::Read(shape, stream);
    } else {
        BRepTools::Read(shape, stream, BRep_Builder());
    }
    if (shape.IsNull()) throw Refused("holds no shape that can be read");
    return shape;
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

/// Names that OpenCASCADE gives to shapes without one.
bool is_made_up(const std::string& name) {
    static constexpr const char* kKinds[] = {"COMPOUND", "COMPSOLID", "SOLID", "SHELL", "FACE", "WIRE", "EDGE", "VERTEX", "SHAPE",
                                             "ASSEMBLY", "=>"};
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

TopoDS_Shape shape_at(const XCAFPrs_DocumentNode& node) { return XCAFDoc_ShapeTool::GetShape(node.RefLabel); }

Shape shape_of(const XCAFPrs_DocumentNode& node) {
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
        for (int i = face.ElemLower(); i <= face.ElemUpper(); ++i) {
            const Poly_Triangle triangle = face.TriangleOriented(i);
            for (int k = 1; k <= 3; ++k) patch.indices.push_back(first + static_cast<std::uint32_t>(triangle(k) - face.NodeLower()));
        }
    }
    return shape;
}

}  // namespace

std::optional<Format> find_format(std::string_view bytes) {
    constexpr std::size_t kBlanks = 8;  // line breaks and marks in front
    for (const Begin& begin : kBegins) {
        const std::size_t at = bytes.substr(0, begin.offset + begin.mark.size() + kBlanks).find(begin.mark);
        if (at != std::string_view::npos && (begin.offset == 0 || at == begin.offset)) return begin.format;
    }
    return std::nullopt;
}

const char* format_name(Format format) { return kNames[static_cast<std::size_t>(format)]; }

Document read_document(const std::string& bytes, Format format, double pixels) {
    const Handle(TDocStd_Document) document = read_shapes(bytes, format);
    Document out{format, {}, {}};
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
    for (double loose = diagonal_of(placed), tight = 0.0;; loose = tight) {
        out.deflection_mm = std::max(kDeflectionPx * loose / pixels, Precision::Confusion());
        for (const XCAFPrs_DocumentNode& leaf : leaves) mesh(shape_at(leaf), out.deflection_mm);
        tight = diagonal_of(placed);
        if (tight >= kSame * loose) break;
    }
    for (const XCAFPrs_DocumentNode& leaf : leaves) out.shapes.push_back(shape_of(leaf));
    return out;
}

}  // namespace halflit::cad
