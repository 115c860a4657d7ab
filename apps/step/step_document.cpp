#include "step/step_document.h"

#include <fmt/format.h>

#include <IFSelect_ReturnStatus.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <Standard_Failure.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs.hxx>
#include <XCAFPrs_IndexedDataMapOfShapeStyle.hxx>
#include <XCAFPrs_Style.hxx>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/mesh_scene.h"
#include "step/step_mesh.h"

namespace arris::step {
namespace {

Error refusal(const std::string& what) {
  return {Error::Kind::input, "", what};
}

void silence() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
}

// UTF-8 without control characters; empty if there is none.
std::string text_of(const TCollection_ExtendedString& extended) {
  const TCollection_AsciiString utf8(extended);
  std::string text(utf8.ToCString(), std::size_t(utf8.Length()));
  std::erase_if(text, [](char c) { return std::uint8_t(c) < 0x20 || c == 0x7F; });
  return problem_with_name(text).empty() ? text : "";
}

// What instances without a name are called: by Open CASCADE "=>[0:1:1:2]" or the number that the file gives them, by
// other programs "NAUO7", after next_assembly_usage_occurrence.
bool is_number(std::string_view name) {
  if (name.starts_with("=>[")) return true;
  if (name.starts_with("NAUO")) name.remove_prefix(4);
  return name.find_first_not_of("0123456789") == std::string_view::npos;
}

std::string name_of(const TDF_Label& label) {
  opencascade::handle<TDataStd_Name> name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  const std::string text = text_of(name->Get());
  return is_number(text) ? "" : text;
}

Affine3d affine_of(const TopLoc_Location& location) {
  const gp_Trsf t = location.Transformation();
  const auto column = [&](int c) { return Vec3d(t.Value(1, c), t.Value(2, c), t.Value(3, c)); };
  return {{column(1), column(2), column(3)}, column(4)};
}

// One material for each colour, called by it, so that scene files can replace it.
class ColorMaterials {
 public:
  explicit ColorMaterials(Scene& scene) : scene_(scene) {}

  MaterialId material_of(const Quantity_ColorRGBA& color) {
    const Quantity_Color rgb = color.GetRGB();
    const auto key =
        std::make_tuple(float(rgb.Red()), float(rgb.Green()), float(rgb.Blue()), color.Alpha());
    const auto [place, is_new] =
        numbers_.try_emplace(key, MaterialId{std::uint32_t(scene_.materials.size())});
    if (is_new) {
      Material& material = scene_.materials.emplace_back();
      material.name = name(color);
      material.base_color = {std::get<0>(key), std::get<1>(key), std::get<2>(key)};
      material.opacity = std::get<3>(key);
    }
    return place->second;
  }

 private:
  // As in web pages: "#ff8000", and "#ff800080" if light passes.
  static std::string name(const Quantity_ColorRGBA& color) {
    TCollection_AsciiString hex = Quantity_ColorRGBA::ColorToHex(color);
    hex.LowerCase();
    std::string text(hex.ToCString());
    return color.Alpha() == 1 ? text.substr(0, 7) : text;
  }

  Scene& scene_;
  std::map<std::tuple<float, float, float, float>, MaterialId> numbers_;
};

class AssemblyReader {
 public:
  explicit AssemblyReader(const opencascade::handle<TDocStd_Document>& document)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colors_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        scene_(make_mesh_scene("")),
        materials_(scene_) {}

  Scene read() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& root : roots) visit(root, {}, {});
    note(missing_faces_, "faces could not be cut into triangles and are left out");
    note(without_surfaces_, "parts have no surfaces and are left out");
    if (scene_.objects.empty()) {
      throw refusal("holds no solids or surfaces that Open CASCADE can read; export solids");
    }
    return std::move(scene_);
  }

 private:
  struct Body {
    MeshId mesh;
    std::string name;
    std::optional<MaterialId> material;
  };
  // What an instance says of its part, and the assemblies around it of parts without a colour.
  struct Instance {
    std::string name;
    std::optional<MaterialId> own, inherited;
  };

  void note(std::size_t count, const char* what) {
    if (count > 0) scene_.notes.push_back(fmt::format("{} {}", count, what));
  }

  void visit(const TDF_Label& label, const TopLoc_Location& place, const Instance& instance) {
    TDF_Label part;
    if (XCAFDoc_ShapeTool::GetReferredShape(label, part)) {
      visit(part, place * XCAFDoc_ShapeTool::GetLocation(label),
            {name_of(label), color_of(label), instance.inherited});
      return;
    }
    if (!XCAFDoc_ShapeTool::IsAssembly(label)) {
      place_part(label, place, instance);
      return;
    }
    Instance inside;
    inside.inherited = instance.own                  ? instance.own
                       : color_of(label).has_value() ? color_of(label)
                                                     : instance.inherited;
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(label, components);
    for (const TDF_Label& component : components) visit(component, place, inside);
  }

  std::optional<MaterialId> color_of(const TDF_Label& label) {
    Quantity_ColorRGBA color;
    if (!colors_->GetColor(label, XCAFDoc_ColorSurf, color) &&
        !colors_->GetColor(label, XCAFDoc_ColorGen, color)) {
      return std::nullopt;
    }
    return materials_.material_of(color);
  }

  void place_part(const TDF_Label& part, const TopLoc_Location& place, const Instance& instance) {
    TCollection_AsciiString entry;
    TDF_Tool::Entry(part, entry);
    const auto [found, is_new] = bodies_.try_emplace(entry.ToCString());
    if (is_new) found->second = make_bodies(part);
    const std::vector<Body>& bodies = found->second;
    if (scene_.objects.size() + bodies.size() > kMaxObjects) {
      throw refusal(fmt::format("places more than {} parts; split the assembly", kMaxObjects));
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      Object& object = scene_.objects.emplace_back();
      object.name = bodies[i].name;
      if (!instance.name.empty()) {
        object.name =
            bodies.size() == 1 ? instance.name : fmt::format("{} {}", instance.name, i + 1);
      }
      object.mesh = bodies[i].mesh;
      object.material = instance.own         ? *instance.own
                        : bodies[i].material ? *bodies[i].material
                                             : instance.inherited.value_or(MaterialId{0});
      object.world_from_object = affine_of(place);
    }
  }

  // Each solid, and what belongs to none.
  std::vector<Body> make_bodies(const TDF_Label& label) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    std::vector<Body> bodies;
    if (shape.IsNull()) return bodies;
    tessellate(shape);
    XCAFPrs_IndexedDataMapOfShapeStyle styles;
    XCAFPrs::CollectStyleSettings(label, TopLoc_Location(), styles);
    std::vector<std::vector<TopoDS_Face>> solids;
    for (TopExp_Explorer s(shape, TopAbs_SOLID); s.More(); s.Next()) {
      solids.push_back(faces_of(s.Current(), TopAbs_SHAPE));
      inherit(s.Current(), styles);
    }
    solids.push_back(faces_of(shape, TopAbs_SOLID));
    inherit(shape, styles);
    std::vector<PartMesh> meshes;
    for (const std::vector<TopoDS_Face>& faces : solids) {
      PartMesh made = make_mesh(faces, [&](const TopoDS_Face& face) { return find(face, styles); });
      missing_faces_ += made.missing_faces;
      if (!made.mesh.triangles.empty()) meshes.push_back(std::move(made));
    }
    if (meshes.empty()) ++without_surfaces_;
    const std::string name = name_of(label);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      Mesh& mesh = meshes[i].mesh;
      mesh.name = meshes.size() == 1 || name.empty() ? name : fmt::format("{} {}", name, i + 1);
      bodies.push_back(
          {MeshId{std::uint32_t(scene_.meshes.size())}, mesh.name, meshes[i].material});
      scene_.meshes.push_back(std::move(mesh));
    }
    return bodies;
  }

  static std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum avoid) {
    std::vector<TopoDS_Face> faces;
    for (TopExp_Explorer f(shape, TopAbs_FACE, avoid); f.More(); f.Next()) {
      faces.push_back(TopoDS::Face(f.Current()));
    }
    return faces;
  }

  // Faces without a colour have that of the solid or part that they belong to.
  static void inherit(const TopoDS_Shape& whole, XCAFPrs_IndexedDataMapOfShapeStyle& styles) {
    const XCAFPrs_Style* const style = styles.Seek(whole);
    if (style == nullptr || !style->IsSetColorSurf()) return;
    const XCAFPrs_Style inherited = *style;
    for (const TopoDS_Face& face : faces_of(whole, TopAbs_SHAPE)) {
      if (!styles.Contains(face)) styles.Add(face, inherited);
    }
  }

  std::optional<MaterialId> find(const TopoDS_Face& face,
                                 const XCAFPrs_IndexedDataMapOfShapeStyle& styles) {
    const XCAFPrs_Style* const style = styles.Seek(face);
    if (style == nullptr || !style->IsSetColorSurf()) return std::nullopt;
    return materials_.material_of(style->GetColorSurfRGBA());
  }

  opencascade::handle<XCAFDoc_ShapeTool> shapes_;
  opencascade::handle<XCAFDoc_ColorTool> colors_;
  Scene scene_;
  ColorMaterials materials_;
  std::map<std::string, std::vector<Body>> bodies_;  // by the part's label
  std::size_t missing_faces_ = 0, without_surfaces_ = 0;
};

void refuse_other_files(const STEPControl_Reader& reader) {
  STEPConstruct_ExternRefs references(reader.WS());
  references.LoadExternRefs();
  if (references.NbExternRefs() == 0) return;
  const char* const name = references.FileName(1);
  throw refusal(
      fmt::format("refers to {} other files, such as {}, which are not read; export the "
                  "assembly as one file",
                  references.NbExternRefs(), in_quotes(name == nullptr ? "" : name)));
}

Scene read(const std::string& file) {
  silence();
  opencascade::handle<TDocStd_Document> document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  silence();  // the application may have brought its own
  STEPCAFControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) {
    throw refusal("Open CASCADE can't read it as STEP; export it again, as AP203, AP214 or AP242");
  }
  refuse_other_files(reader.Reader());
  if (!reader.Transfer(document)) {
    throw refusal(
        "holds no parts that Open CASCADE can read; export solids as AP203, AP214 or AP242");
  }
  return AssemblyReader(document).read();
}

}  // namespace

Scene read_step_document(const std::filesystem::path& file) {
  try {
    return read(file.string());
  } catch (const Standard_Failure& failure) {
    throw refusal(fmt::format("Open CASCADE can't read it ({}); export it again, or as STL",
                              in_quotes(failure.DynamicType()->Name())));
  } catch (const std::bad_alloc&) {
    throw refusal("Open CASCADE needs more memory for it than there is; export it as STL");
  }
}

}  // namespace arris::step
