// command_table.cpp — the table itself: a new option is one row here and its use in the command
#include "arris/command_line.h"
#include "arris/commands.h"

namespace arris::program {
namespace {

const OptionRow kHelp{"--help", "", "show this help"};

OptionGroup rounding_group(const std::string& default_radius) {
  return {
      "Rounded edges",
      {{"--round", "auto|none|R|R%",
        "radius in scene units, or in percent of each object's inradius (the largest ball that "
        "fits; half its walls and faces where it isn't convex); auto: large enough to be seen, "
        "small enough for the part (default: " +
            default_radius + ", what the file says for scenes)"},
       {"--round-edges", "convex|concave|both",
        "which edges (default: the file's, else convex); concave ones get fillets where the solid "
        "is "
        "closed, and a note counts those that stay sharp"},
       {"--round-on-overlap", "report|clamp",
        "edges beside which the radius has no room; report: they stay sharp and are reported; "
        "clamp: "
        "they get a smaller one (default: the file's, else report)"},
       {"--round-min-angle", "DEG",
        "edges that turn by less are part of a smooth surface (default: the file's, else 30); STEP "
        "files say themselves which edges are sharp"},
       {"--round-method", "exact|shader|mesh:N|none",
        "exact: rounded surfaces; shader: bevel shader, normals only; mesh:N: bevel geometry of N "
        "subdivisions (default: the file's, else exact)"}}};
}

OptionGroup edge_point_group() {
  return {
      "Edges and points",
      {{"--shader", "direct|glossy|gi",
        "edge-point: which light points are shaded with: direct, and that of glossy surfaces, "
        "or all (default: gi)"},
       {"--density", "PART",
        "edge-point: of the pixels that are shaded anew for each frame (default: 0.02, up to 0.2 "
        "where something has moved; 1 for a single picture)"},
       {"--point-paths", "N",
        "edge-point: paths for each point (default: 4 direct, 8 glossy, 16 gi)"},
       {"--trace-below", "MS",
        "edge-point: frames for which paths through every pixel are so cheap, at 4 million "
        "rays a second, are traced instead, which is said; 0: none (default: 16)"},
       {"--edges", "on|off",
        "edge-point: off interpolates across all edges, for comparison (default: on)"}}};
}

OptionGroup input_group() {
  return {
      "Input",
      {{"--facets", "exact|as-written",
        "round things in OpenSCAD files; exact: true spheres, cylinders and circles, but for those "
        "with an explicit $fn of 12 or less; as-written: with OpenSCAD's facets (default: "
        "exact)"}}};
}

OptionGroup camera_group() {
  return {"Camera (without one the model is framed in a three-quarter view)",
          {{"--camera-position", "X,Y,Z", "where the camera is"},
           {"--camera-target", "X,Y,Z",
            "what it looks at (default: the file's, else the middle of the model)"},
           {"--camera-up", "X,Y,Z", "up in the picture (default: the file's up, Z for most)"},
           {"--fov", "DEG", "vertical field of view (default: the file's, else 35)"}}};
}

OptionGroup staging_group() {
  return {"Staging",
          {{"--lighting", "studio|sky|white",
            "replaces the file's lights (default: the file's, else studio)"},
           {"--material", "NAME", "replaces the file's materials; --material list shows the names"},
           {"--ground", "on|off",
            "a soft ground (default: the file's; on for bare models without a camera)"}}};
}

CommandRow render_row() {
  return {
      "render",
      "INPUT",
      1,
      1,
      "make a picture of a model or scene",
      "A bare model (STL, OBJ, PLY, OFF, STEP, glTF, OpenSCAD) is staged: framed, put on a soft "
      "ground, "
      "lit as in a studio, its edges rounded. A scene file (.toml) is rendered as it says. INPUT "
      "may be - for stdin: its format is told by its content. Ctrl-C ends the render early "
      "and keeps "
      "the picture of the samples made so far, if there are any (exit code 1); a second Ctrl-C "
      "ends "
      "the program.",
      {{"Output",
        {{"-o,--output", "FILE",
          "the picture: .png .jpg (tone-mapped), .exr .pfm (linear); - writes PNG to stdout"},
         {"--aov", "LIST",
          "more layers, separated by commas: albedo, normal, depth, object, rounded, bevel_fac "
          "(path); coverage_lo, coverage_hi, uncertified, regions (beam); edges (edge-point); part "
          "of "
          "an .exr, else "
          "beside the picture as .NAME.pfm, and with .png and .jpg, where values go from 0 to 1, "
          "as "
          ".NAME.png to look at"},
         {"--exposure", "STOPS", "brightness of .png and .jpg (default: the scene's, else 0)"},
         {"--frames", "A..B",
          "the frames from A up to B, without B, of a scene with keys: -o f_####.png makes "
          "f_0000.png and so on; without it frame 0 is rendered"},
         {"--stats", "FILE", "write times, counts and memory as JSON; - for stdout"}}},
       {"Picture",
        {{"--size", "WxH", "in pixels (default: the scene's, else 1280x720)"},
         {"--spp", "N", "samples per pixel (default: the scene's, else 64)"},
         {"--time", "SECONDS",
          "end after this time, with the samples made until then, at least one; of each frame"},
         {"--denoise", "none|edges",
          "edges: light is averaged up to the edges that are found in the scene, textures stay as "
          "they are (path; default: none)"},
         {"--max-depth", "N", "bounces of light (default: the scene's, else 8)"},
         {"--seed", "N", "another pattern of noise (default: 0)"},
         {"--samples", "A..B",
          "only these samples of the sequence (path); arris merge joins such .exr parts, which "
          "hold their "
          "exact sums besides, to the bytes of the whole"},
         {"--integrator", "path|beam|edge-point",
          "path: path tracing; beam: what is small is found or its pixel marked, with certain "
          "bounds on what each pixel shows; edge-point: from few shaded points, interpolated "
          "between edges, for moving views (default: path)"},
         {"--beam-rule", "certified|corners",
          "how beams find uniform regions; certified: by bounds that hold; corners: by four rays, "
          "as in the paper of 1996, for comparison (default: certified)"},
         {"--light-beams", "N",
          "beam: each area light is N x N point lights, whose shadows have no noise; 0: it is "
          "sampled "
          "(default: 0)"}}},
       edge_point_group(),
       input_group(),
       camera_group(),
       staging_group(),
       rounding_group("auto for bare models"),
       {"Running",
        {{"--threads", "N", "default: all; the picture does not depend on it"},
         {"--checkpoint", "FILE",
          "save the state (.exr) every 30 s and go on from it; the picture is the same as without "
          "a break"},
         {"--quiet", "", "print errors only"},
         {"--verbose", "", "print what was found and done"},
         kHelp}}},
      {{"arris render bracket.stl -o bracket.png", "a picture with rounded edges"},
       {"arris render bracket.stl -o bracket.png --round 0.5 --material brass",
        "radius 0.5, brass"},
       {"arris render room.toml -o room.exr --spp 1024 --checkpoint room.state.exr",
        "a long render that may be interrupted"},
       {"arris render part.glb -o part.png --size 512x512 --time 10", "ten seconds' work"},
       {"zcat part.stl.gz | arris render - -o part.png", "a model through a pipe"},
       {"arris render part.obj -o a.exr --samples 0..512",
        "the first half of a render on two machines"},
       {"arris render turntable.toml -o f_####.png --frames 0..48",
        "48 frames of a scene with keys"}},
      run_render};
}

CommandRow view_row() {
  return {
      "view",
      "INPUT",
      1,
      1,
      "turn a model or scene under real light, in the browser",
      "Prints an address, and opens it where there is a desktop: a page that shows the model as "
      "arris render stages it and follows the mouse. The address holds a secret, and only this "
      "machine is listened to: for another one use a tunnel, such as ssh -L 7878:localhost:7878. "
      "Ctrl-C ends it. INPUT may be - for stdin.",
      {{"Server",
        {{"--host", "ADDRESS",
          "where to listen; 0.0.0.0: for all that can reach this machine, who then need the "
          "secret only (default: 127.0.0.1, this machine alone)"},
         {"--port", "N", "0: any that is free (default: 7878, or any if it is taken)"},
         {"--token", "TOKEN",
          "of the address, so that pages come back when the viewer is started again: 16 or more of "
          "A-Z a-z 0-9 _ - (default: a new one each time)"},
         {"--no-browser", "", "only print the address"},
         {"--once", "", "end when the last page has been closed"},
         {"--watch", "", "show the model anew when one of its files changes"},
         {"--allow-upload", "", "pages may show models that are dropped on them"}}},
       {"Picture",
        {{"--size", "WxH", "of the first picture, in pixels (default: the page's)"},
         {"--spp", "N",
          "samples per pixel at which a view that stands still is finished (default: the scene's, "
          "else 64)"},
         {"--max-depth", "N", "bounces of light (default: the scene's, else 8)"},
         {"--exposure", "STOPS", "brightness (default: the scene's, else 0)"},
         {"--shader", "direct|glossy|gi",
          "which light is shown: direct, and that of glossy surfaces, or all (default: gi)"},
         {"--trace-below", "MS",
          "frames that take less are traced, pixel by pixel; 0: none (default: 16)"}}},
       input_group(),
       camera_group(),
       staging_group(),
       rounding_group("auto for bare models"),
       {"Running",
        {{"--threads", "N", "default: all"},
         {"--quiet", "", "print errors only besides the address"},
         {"--verbose", "", "print what was found and done"},
         kHelp}}},
      {{"arris view bracket.stl", "in the browser, or at the address that it prints"},
       {"arris view bracket.csg --watch --round 0.5", "beside an editor"},
       {"arris view part.glb --no-browser --port 7878", "on another machine, through a tunnel"}},
      run_view};
}

CommandRow info_row() {
  return {"info",
          "INPUT",
          1,
          1,
          "say what is in a model or scene",
          "Prints for each object its triangles, its edges by kind, whether it is closed and "
          "convex, and what "
          "rounding would do with it. INPUT may be - for stdin.",
          {input_group(),
           rounding_group("auto for bare models"),
           {"Output",
            {{"--json", "", "as JSON, with all digits"},
             {"--threads", "N", "default: all"},
             {"--quiet", "", "print errors only besides the report"},
             kHelp}}},
          {{"arris info bracket.stl", "a report to read"},
           {"arris info bracket.stl --json --round 0.5", "for programs, with a radius of 0.5"}},
          run_info};
}

CommandRow shoot_row() {
  return {
      "shoot",
      "INPUT",
      1,
      1,
      "shoot rays at a model and print what they hit",
      "Each input line holds a ray: ox oy oz dx dy dz. Empty lines and lines that begin with # are "
      "skipped. Each output line is JSON: t in lengths of the direction (null: nothing hit), "
      "position, unit "
      "normal outward from the solid, object, feature (face, edge, corner, fillet, csg), and "
      "inside: the "
      "ray "
      "started in "
      "the solid, so that t is where it leaves. All 17 digits count on flat faces; rounded edges "
      "and corners are met in single precision, about seven digits of the scene's size. INPUT may "
      "be - for stdin.",
      {{"Rays", {{"--rays", "FILE", "file of rays; - reads stdin (required)"}}},
       input_group(),
       rounding_group("none for bare models"),
       {"Running",
        {{"--threads", "N", "default: all"},
         {"--quiet", "", "print errors only besides the hits"},
         kHelp}}},
      {{"arris shoot bracket.stl --rays rays.txt", "one JSON line per ray"},
       {"echo '0 0 9 0 0 -1' | arris shoot bracket.stl --rays -", "a single ray from above"},
       {"arris shoot die.stl --rays rays.txt --round 0.5", "against the rounded solid"}},
      run_shoot};
}

CommandRow merge_row() {
  return {"merge",
          "A.exr B.exr ...",
          1,
          4096,
          "join parts of one render",
          "The parts are .exr files that arris render wrote with --samples or that were "
          "interrupted. Parts of "
          "different scenes, sizes or seeds and parts that share samples are refused. The picture "
          "has the bytes of one rendered in one piece.",
          {{"Output",
            {{"-o,--output", "FILE", "the whole picture: .exr, or .png .jpg .pfm (required)"},
             {"--exposure", "STOPS", "brightness of .png and .jpg (default: 0)"},
             {"--part", "",
              "the picture is itself a part: keep the sums in it (default: if it lacks samples "
              "from 0 on)"},
             {"--quiet", "", "print errors only"},
             kHelp}}},
          {{"arris merge a.exr b.exr -o whole.exr", "two halves"}},
          run_merge};
}

CommandRow compare_row() {
  return {"compare",
          "A B",
          2,
          2,
          "measure how far two pictures are apart",
          "Prints RMSE, largest difference, PSNR and FLIP (a perceptual measure, 0: equal, 1: as "
          "different "
          "as can be). .exr, .pfm and .hdr are compared by their linear values, .png and .jpg by "
          "their codes "
          "(0 to 1); of one of each the linear one is tone-mapped first.",
          {{"Output",
            {{"--max-rmse", "X", "exit with 1 if the RMSE is larger"},
             {"--diff", "FILE", "write the FLIP map as a picture, dark: equal, bright: different"},
             {"--json", "", "as JSON"},
             {"--quiet", "", "print errors only: the exit code is the answer"},
             kHelp}}},
          {{"arris compare out.png reference.png", "four numbers"},
           {"arris compare out.exr reference.exr --max-rmse 0.001", "as a test in a script"}},
          run_compare};
}

}  // namespace

std::span<const CommandRow> commands() {
  static const std::vector<CommandRow> kCommands{render_row(), view_row(),  info_row(),
                                                 shoot_row(),  merge_row(), compare_row()};
  return kCommands;
}

}  // namespace arris::program
