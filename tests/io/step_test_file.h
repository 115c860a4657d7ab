// step_test_file.h — STEP files of prisms, for tests: closed forms are known of all that they hold
// What       prisms over outlines of lines and arcs with round holes, as parts with names and colours, at places of an
//            assembly or alone
// Legend     each function that adds entities returns the number of the one that stands for them
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace arris::test {

struct StepArc {
  double x = 0, y = 0;  // of its centre
  bool counter_clockwise = true;
};
// From here to the next one's beginning, the last to the first.
struct StepSegment {
  double x = 0, y = 0;
  std::optional<StepArc> arc;
};
struct StepHole {
  double x = 0, y = 0, radius = 1;
};
struct StepPrism {
  std::vector<StepSegment> outline;  // counter-clockwise, seen from above
  std::vector<StepHole> holes;
  double height = 1;
};

inline StepPrism step_box(double a, double b, double c) {
  return {{{0, 0, {}}, {a, 0, {}}, {a, b, {}}, {0, b, {}}}, {}, c};
}

class StepFile {
 public:
  // unit: as "SI_UNIT(.MILLI.,.METRE.)"
  explicit StepFile(const std::string& unit = "SI_UNIT(.MILLI.,.METRE.)") {
    const int length = add("(LENGTH_UNIT()NAMED_UNIT(*)" + unit + ")");
    const int angle = add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
    const int solid_angle = add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
    const int uncertainty = add(fmt::format(
        "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-6),#{},'distance','')", length));
    context_ = add(
        fmt::format("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{}))"
                    "GLOBAL_UNIT_ASSIGNED_CONTEXT((#{},#{},#{}))REPRESENTATION_CONTEXT('',''))",
                    uncertainty, length, angle, solid_angle));
    application_ = add("APPLICATION_CONTEXT('automotive design')");
    product_context_ = add(fmt::format("PRODUCT_CONTEXT('',#{},'mechanical')", application_));
    definition_context_ = add(
        fmt::format("PRODUCT_DEFINITION_CONTEXT('part definition',#{},'design')", application_));
  }

  struct Part {
    int definition = 0, representation = 0, axes = 0;
  };

  // Of one solid or several.
  Part add_part(const std::string& name, const std::vector<int>& solids) {
    Part part = add_product(name);
    part.axes = axes(0, 0, 0);
    std::string items = fmt::format("#{}", part.axes);
    for (const int solid : solids) items += fmt::format(",#{}", solid);
    part.representation =
        add(fmt::format("ADVANCED_BREP_SHAPE_REPRESENTATION('',({}),#{})", items, context_));
    represent(part);
    return part;
  }

  struct Place {
    std::string name;
    double x = 0, y = 0, z = 0;
  };
  Part add_assembly(const std::string& name, const Part& of, const std::vector<Place>& places) {
    Part assembly = add_product(name);
    assembly.axes = axes(0, 0, 0);
    std::vector<int> targets;
    std::string items = fmt::format("#{}", assembly.axes);
    for (const Place& place : places) {
      targets.push_back(axes(place.x, place.y, place.z));
      items += fmt::format(",#{}", targets.back());
    }
    assembly.representation =
        add(fmt::format("SHAPE_REPRESENTATION('',({}),#{})", items, context_));
    represent(assembly);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const int use = add(fmt::format("NEXT_ASSEMBLY_USAGE_OCCURRENCE('{}','{}','',#{},#{},$)",
                                      i + 1, places[i].name, assembly.definition, of.definition));
      const int shape = add(fmt::format("PRODUCT_DEFINITION_SHAPE('','',#{})", use));
      const int transformation =
          add(fmt::format("ITEM_DEFINED_TRANSFORMATION('','',#{},#{})", of.axes, targets[i]));
      const int relation =
          add(fmt::format("(REPRESENTATION_RELATIONSHIP('','',#{},#{})"
                          "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{})SHAPE_"
                          "REPRESENTATION_RELATIONSHIP())",
                          of.representation, assembly.representation, transformation));
      add(fmt::format("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{},#{})", relation, shape));
    }
    return assembly;
  }

  void color(int item, double r, double g, double b) {
    const int rgb = add(fmt::format("COLOUR_RGB('',{:.4f},{:.4f},{:.4f})", r, g, b));
    const int fill = add(fmt::format("FILL_AREA_STYLE_COLOUR('',#{})", rgb));
    const int area = add(fmt::format("FILL_AREA_STYLE('',(#{}))", fill));
    const int surface = add(fmt::format("SURFACE_STYLE_FILL_AREA(#{})", area));
    const int side = add(fmt::format("SURFACE_SIDE_STYLE('',(#{}))", surface));
    const int usage = add(fmt::format("SURFACE_STYLE_USAGE(.BOTH.,#{})", side));
    const int style = add(fmt::format("PRESENTATION_STYLE_ASSIGNMENT((#{}))", usage));
    const int styled = add(fmt::format("STYLED_ITEM('color',(#{}),#{})", style, item));
    add(fmt::format("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#{}),#{})", styled,
                    context_));
  }

  struct Solid {
    int solid = 0;
    std::vector<int> faces;  // bottom, top, those of the outline, those of the holes
  };
  Solid add_prism(const StepPrism& prism) { return Builder{*this, prism}.build(); }

  [[nodiscard]] std::string text() const {
    return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
           "FILE_NAME('part','2020-01-01T00:00:00',(''),(''),'','','');\n"
           "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n" +
           entities_ + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

 private:
  int add(const std::string& entity) {
    entities_ += fmt::format("#{}={};\n", ++count_, entity);
    return count_;
  }

  Part add_product(const std::string& name) {
    const int product = add(fmt::format("PRODUCT('{0}','{0}','',(#{1}))", name, product_context_));
    const int formation = add(fmt::format("PRODUCT_DEFINITION_FORMATION('','',#{})", product));
    return {add(
        fmt::format("PRODUCT_DEFINITION('design','',#{},#{})", formation, definition_context_))};
  }
  void represent(const Part& part) {
    const int shape = add(fmt::format("PRODUCT_DEFINITION_SHAPE('','',#{})", part.definition));
    add(fmt::format("SHAPE_DEFINITION_REPRESENTATION(#{},#{})", shape, part.representation));
  }

  int point(double x, double y, double z) {
    return add(fmt::format("CARTESIAN_POINT('',({:.12f},{:.12f},{:.12f}))", x, y, z));
  }
  int direction(double x, double y, double z) {
    return add(fmt::format("DIRECTION('',({:.15f},{:.15f},{:.15f}))", x, y, z));
  }
  int axes(double x, double y, double z, std::array<double, 3> axis = {0, 0, 1},
           std::array<double, 3> first = {1, 0, 0}) {
    const int origin = point(x, y, z), up = direction(axis[0], axis[1], axis[2]);
    return add(fmt::format("AXIS2_PLACEMENT_3D('',#{},#{},#{})", origin, up,
                           direction(first[0], first[1], first[2])));
  }

  struct Builder {
    StepFile& file;
    const StepPrism& prism;

    Solid build() {
      const std::size_t n = prism.outline.size();
      std::vector<int> bottom_corners, top_corners;
      for (const StepSegment& s : prism.outline) {
        bottom_corners.push_back(vertex(s.x, s.y, 0));
        top_corners.push_back(vertex(s.x, s.y, prism.height));
      }
      std::vector<int> bottom, top, up;
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        bottom.push_back(edge(i, 0, bottom_corners[i], bottom_corners[j]));
        top.push_back(edge(i, prism.height, top_corners[i], top_corners[j]));
        up.push_back(line(prism.outline[i].x, prism.outline[i].y, 0, {0, 0, 1}, bottom_corners[i],
                          top_corners[i]));
      }
      std::vector<std::string> bottom_bounds{reversed_bound(bottom)}, top_bounds{bound(top)};
      std::vector<int> sides;
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = (i + 1) % n;
        sides.push_back(
            face({loop({{bottom[i], true}, {up[j], true}, {top[i], false}, {up[i], false}})},
                 side_surface(i), !is_hollow(i)));
      }
      for (const StepHole& hole : prism.holes) {
        sides.push_back(add_hole(hole, bottom_bounds, top_bounds));
      }
      const int below = file.add(fmt::format("PLANE('',#{})", file.axes(0, 0, 0, {0, 0, -1})));
      const int above = file.add(fmt::format("PLANE('',#{})", file.axes(0, 0, prism.height)));
      Solid solid;
      solid.faces = {face(bottom_bounds, below, true), face(top_bounds, above, true)};
      solid.faces.insert(solid.faces.end(), sides.begin(), sides.end());
      std::string all;
      for (const int f : solid.faces) all += fmt::format("{}#{}", all.empty() ? "" : ",", f);
      const int shell = file.add(fmt::format("CLOSED_SHELL('',({}))", all));
      solid.solid = file.add(fmt::format("MANIFOLD_SOLID_BREP('',#{})", shell));
      return solid;
    }

    [[nodiscard]] bool is_hollow(std::size_t i) const {
      return prism.outline[i].arc && !prism.outline[i].arc->counter_clockwise;
    }

    int vertex(double x, double y, double z) {
      return file.add(fmt::format("VERTEX_POINT('',#{})", file.point(x, y, z)));
    }
    int line(double x, double y, double z, std::array<double, 3> d, int from, int to) {
      const int along =
          file.add(fmt::format("VECTOR('',#{},1.)", file.direction(d[0], d[1], d[2])));
      const int curve = file.add(fmt::format("LINE('',#{},#{})", file.point(x, y, z), along));
      return file.add(fmt::format("EDGE_CURVE('',#{},#{},#{},.T.)", from, to, curve));
    }
    int circle(double x, double y, double z, double radius, int from, int to, bool forward) {
      const int curve = file.add(fmt::format("CIRCLE('',#{},{:.12f})", file.axes(x, y, z), radius));
      return file.add(fmt::format("EDGE_CURVE('',#{},#{},#{},{})", from, to, curve, flag(forward)));
    }
    int edge(std::size_t i, double z, int from, int to) {
      const StepSegment& s = prism.outline[i];
      if (s.arc) {
        return circle(s.arc->x, s.arc->y, z, std::hypot(s.x - s.arc->x, s.y - s.arc->y), from, to,
                      s.arc->counter_clockwise);
      }
      const auto [dx, dy] = along(i);
      return line(s.x, s.y, z, {dx, dy, 0}, from, to);
    }
    [[nodiscard]] std::array<double, 2> along(std::size_t i) const {
      const StepSegment &a = prism.outline[i], &b = prism.outline[(i + 1) % prism.outline.size()];
      const double size = std::hypot(b.x - a.x, b.y - a.y);
      return {(b.x - a.x) / size, (b.y - a.y) / size};
    }
    int side_surface(std::size_t i) {
      const StepSegment& s = prism.outline[i];
      if (s.arc) {
        return cylinder(s.arc->x, s.arc->y, std::hypot(s.x - s.arc->x, s.y - s.arc->y));
      }
      const auto [dx, dy] = along(i);
      return file.add(
          fmt::format("PLANE('',#{})", file.axes(s.x, s.y, 0, {dy, -dx, 0}, {dx, dy, 0})));
    }
    int cylinder(double x, double y, double radius) {
      return file.add(
          fmt::format("CYLINDRICAL_SURFACE('',#{},{:.12f})", file.axes(x, y, 0), radius));
    }

    int add_hole(const StepHole& hole, std::vector<std::string>& bottom_bounds,
                 std::vector<std::string>& top_bounds) {
      const double x = hole.x + hole.radius;
      const int below = vertex(x, hole.y, 0), above = vertex(x, hole.y, prism.height);
      const int bottom = circle(hole.x, hole.y, 0, hole.radius, below, below, true);
      const int top = circle(hole.x, hole.y, prism.height, hole.radius, above, above, true);
      const int seam = line(x, hole.y, 0, {0, 0, 1}, below, above);
      bottom_bounds.push_back(loop({{bottom, true}}));
      top_bounds.push_back(loop({{top, false}}));
      return face({loop({{seam, true}, {top, true}, {seam, false}, {bottom, false}})},
                  cylinder(hole.x, hole.y, hole.radius), false);
    }

    struct Use {
      int edge = 0;
      bool forward = true;
    };
    std::string loop(const std::vector<Use>& uses) {
      std::string all;
      for (const Use& use : uses) {
        const int oriented =
            file.add(fmt::format("ORIENTED_EDGE('',*,*,#{},{})", use.edge, flag(use.forward)));
        all += fmt::format("{}#{}", all.empty() ? "" : ",", oriented);
      }
      return fmt::format("#{}", file.add(fmt::format("EDGE_LOOP('',({}))", all)));
    }
    std::string bound(const std::vector<int>& edges) {
      std::vector<Use> uses;
      for (const int e : edges) uses.push_back({e, true});
      return loop(uses);
    }
    std::string reversed_bound(const std::vector<int>& edges) {
      std::vector<Use> uses;
      for (std::size_t i = edges.size(); i-- > 0;) uses.push_back({edges[i], false});
      return loop(uses);
    }
    int face(const std::vector<std::string>& loops, int surface, bool same_sense) {
      std::string bounds;
      for (const std::string& edges : loops) {
        const int b = file.add(fmt::format(
            "{}('',{},.T.)", bounds.empty() ? "FACE_OUTER_BOUND" : "FACE_BOUND", edges));
        bounds += fmt::format("{}#{}", bounds.empty() ? "" : ",", b);
      }
      return file.add(
          fmt::format("ADVANCED_FACE('',({}),#{},{})", bounds, surface, flag(same_sense)));
    }
    static const char* flag(bool value) { return value ? ".T." : ".F."; }
  };

  std::string entities_;
  int count_ = 0;
  int context_ = 0, application_ = 0, product_context_ = 0, definition_context_ = 0;
};

}  // namespace arris::test
