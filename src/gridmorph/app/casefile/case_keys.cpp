#include <gridmorph/app/casefile/case_keys.hpp>

#include <array>

namespace gridmorph {

namespace {

constexpr auto list = std::to_array<CaseKey>({
    // clang-format off
    {"", "default", R"("type" or "error")", "", R"("type")", R"(default = "error")",
     "A patch that no rule matches: takes the default of its kind (symmetry planes slip on their plane, periodic pairs move "
     "freely as one, everything else stays fixed), or is an error. Must stand before the first table"},
    {"", "mesh", "table", "", "required", R"([mesh])", "What to morph"},
    {"", "motion", "list of tables", "", "required", R"([[motion]])", "How the boundary moves: one table per rule"},
    {"", "constants", "table", "", "none", "[constants]", "Constants for all formulas"},
    {"", "conformity", "table", "", "none", "[conformity]", "When displacements agree"},
    {"", "boundary_layer", "table or list of tables", "", "one for all moving walls", "[boundary_layer]", "Near field of moving walls"},
    {"", "volume", "table", "", "none", "[volume]", "How the volume of a structured mesh follows"},
    {"", "near_field", "table", "", "none", "[near_field]\noffset = 0.02", "Wrap and layers around the moving walls of an unstructured mesh"},
    {"", "background", "table", "", "none", "[background]\ncells = 4", "Background mesh between the wrap and the outer boundary of an unstructured mesh"},
    {"", "guard", "table", "", "none", "[guard]", "When the result counts as good"},
    {"", "sequence", "table", "", "none", "[sequence]\nsteps = 32\noutput = \"flutter_{step}.cgns\"", "Meshes over time from one plan"},
    {"", "wheel", "table", "", "none", "[wheel]\noutput = \"wheel.cgns\"", "A wheel of passages, for `gridmorph wheel`"},
    {"", "output", "table", "", "none", "[output]", "What is written beside the mesh"},

    {"mesh", "input", "file", "", "required", R"(input = "passage.cgns")", "The baseline mesh: CGNS or PLOT3D"},
    {"mesh", "output", "file", "", "`--output`", R"(output = "morphed.cgns")",
     "The morphed mesh, in the format of the input; `--output` overrides it. Never the input"},
    {"mesh", "side_file", "file", "", "the mesh's name with .toml, if there", R"(side_file = "passage_sides.toml")",
     "Patches, interfaces and periodicity that the mesh file does not say ([formats.md](formats.md))"},
    {"mesh", "leave_out", "string or list", "", "none", R"(leave_out = ["Base 2", "Base/probe line"])",
     "Bases and zones of a CGNS file that are no part of the mesh (globs). They stay as they are; connections that lead to them become patches"},
    {"mesh", "axis", R"(table, or "x", "y", "z")", "", "none", "axis = { origin = [0, 0, 0], direction = [1, 0, 0] }",
     "The machine axis. Rules that need an axis are an error without one"},
    {"mesh", "matching_tolerance", "number > 0", "length", "1e-8 of the mesh size, 1e-6 for single precision",
     "matching_tolerance = 1e-6", "Largest distance between nodes that a 1-to-1 interface declares coincident"},
    {"mesh", "open_faces", "string", "", "they are an error", R"(open_faces = "open")",
     "Faces that no patch and no interface claims become a patch of this name"},
    {"mesh axis", "origin", "[x, y, z]", "length", "[0, 0, 0]", "axis = { origin = [0, 0, 0.5], direction = [1, 0, 0] }",
     "A point on the axis"},
    {"mesh axis", "direction", "[x, y, z]", "1", "required", "axis = { direction = [0, 0, 1] }",
     "Along the axis, of any length; angles are right-handed about it"},

    {"constants", "<name>", "number", "any", "none", "[constants]\nspan = 14.0", "A constant that all formulas may use"},

    {"motion", "patches", "string or list", "", "required", R"(patches = ["blade", "tip_*"])",
     "What moves: family names first, then BC names, then connection names; where zones use the same BC name, `zone/name` tells them "
     R"(apart (`"row1/blade_ps"`); `*` and `?` are globs; `type:wall`, `type:inflow`, `type:outflow`, `type:symmetry`, )"
     "`type:farfield`, `type:connection`, `type:other`, `type:periodic` go by kind"},
    {"motion", "rule", "string", "", "required", R"(rule = "fixed")", "One of the rules below"},
    {"motion", "rank", "whole number", "1", "0", "rank = 1",
     "Where patches meet and their displacements disagree, the lower rank wins; equal ranks that disagree are an error"},
    {"motion", "amplitude", "number, expression or list of [time, value]", "1", "1", "amplitude = 0.5",
     "How much of the motion: of `rigid`, `formula`, `field`, `sections`, `target` and `contour`. A list (at times) or an expression with `t` or "
     "`step` needs [sequence]; see [amplitudes](#amplitudes-over-time)"},
    {"motion", "amplitude_law", "\"linear\" or \"smooth\"", "", "\"linear\"", "amplitude = [[0, 0], [1, 1]]\namplitude_law = \"smooth\"",
     "With a list: between its times straight, or level at each of them (3s^2 - 2s^3)"},

    {"motion rigid", "scale", "factor, [sx, sy, sz] or table", "1", "1", "scale = 0.95", "Applied first; about [0, 0, 0] unless the table has an origin"},
    {"motion rigid", "rotation", "table", "", "none", "rotation = { angle_deg = 5, axis = [1, 0, 0], origin = [0, 0, 0] }", "Applied second"},
    {"motion rigid", "translation", "[x, y, z]", "length", "[0, 0, 0]", "translation = [0.1, 0, 0]", "Applied last"},
    {"motion rigid", "steps", "list of tables", "", "none", "steps = [ { translation = [0.1, 0, 0] }, { scale = 1.1 } ]",
     "Tables with these three keys, applied one after another, for any other order"},
    {"motion rigid rotation", "angle_deg", "number", "deg", "required", "rotation = { angle_deg = 5, axis = [0, 0, 1], origin = [0, 0, 0] }", "Right-handed about the axis"},
    {"motion rigid rotation", "axis", "[x, y, z]", "1", "the machine axis", "rotation = { angle_deg = 5, axis = [0, 0, 1], origin = [0, 0, 0] }", "Direction to turn about"},
    {"motion rigid rotation", "origin", "[x, y, z]", "length", "required with `axis`", "rotation = { angle_deg = 5, axis = [0, 0, 1], origin = [1, 0, 0] }", "A point on the line to turn about"},
    {"motion rigid scale", "factor", "factor or [sx, sy, sz]", "1", "required", "scale = { factor = [1, 1, 1.05], origin = [0, 0, 0] }", "Positive"},
    {"motion rigid scale", "origin", "[x, y, z]", "length", "[0, 0, 0]", "scale = { factor = 1.02, origin = [0, 0, 1] }", "The point that stays"},

    {"motion rigid steps", "scale", "as above", "1", "1", "steps = [ { scale = 1.1 } ]", "First in its step"},
    {"motion rigid steps", "rotation", "as above", "", "none", "steps = [ { rotation = { angle_deg = 5, axis = [0, 0, 1], origin = [0, 0, 0] } } ]", "Second in its step"},
    {"motion rigid steps", "translation", "as above", "length", "[0, 0, 0]", "steps = [ { translation = [0.1, 0, 0] } ]", "Last in its step"},

    {"motion formula", "dx", "expression", "length", "0", R"~(dx = "-y * twist * z / 14"
constants = { twist = 0.087 })~", "Displacement along x"},
    {"motion formula", "dy", "expression", "length", "0", R"~(dy = "1.5 * (z / 14)^2")~", "Displacement along y"},
    {"motion formula", "dz", "expression", "length", "0", R"~(dz = "0.01 * sin(x)")~", "Displacement along z"},
    {"motion formula", "dr", "expression", "length", "0", R"(dr = "0.01 * axial")", "Displacement away from the axis; 0 on the axis itself"},
    {"motion formula", "dtheta", "expression", "rad", "0", R"(dtheta = "2 * deg * r")", "Angle about the axis, not r times the angle"},
    {"motion formula", "daxial", "expression", "length", "0", R"~(daxial = "0.002 * (r - 1)")~", "Displacement along the axis"},
    {"motion formula", "constants", "table of numbers", "any", "none", R"(dx = "a * z"
constants = { a = 0.1 })", "Names for this rule, which win over [constants]"},
    {"motion formula constants", "<name>", "number", "any", "none", R"(dx = "a * z"
constants = { a = 0.1 })", "A constant of this rule"},

    {"motion field", "file", "file", "length", "required unless there are `modes`", R"(file = "displacement.csv")",
     "Text with columns x, y, z, dx, dy, dz, or a CGNS file with elements ([formats.md](formats.md#structural-models))"},
    {"motion field", "elements", "file", "", "none", R"(file = "displacement.csv"
elements = "blade_elements.csv")", "The elements between the points of a text file"},
    {"motion field", "solution", "name", "", "the first that fits", R"(file = "blade.cgns"
solution = "Hot")", "The `FlowSolution_t` of a CGNS file that holds the displacement"},
    {"motion field", "modes", "list of tables", "", "none", R"(modes = [ { file = "bending.csv", amplitude = 0.004 } ])",
     "Mode shapes that oscillate about the displacement of `file` (about no displacement without it); see below"},
    {"motion field", "length_scale", "number > 0", "1", "1", R"(file = "displacement.csv"
length_scale = 1e-3)", "Multiplies positions and displacements: 1e-3 for a file in mm and a mesh in m"},
    {"motion field", "factor", "number", "1", "1", R"(file = "displacement.csv"
factor = 0.5)", "Multiplies displacements: the amplitude of a mode shape"},
    {"motion field", "max_distance", "number > 0", "length", "no limit", R"(file = "displacement.csv"
max_distance = 1e-3)", "A node farther than this from every point, or from the elements, is an error"},
    {"motion field", "extrapolation", R"("linear" or "nearest")", "", R"("linear")", R"(file = "displacement.csv"
extrapolation = "nearest")", "Beyond the edge of the model the field goes on as it ends there (by no more than an element, or twice "
     "the reach of the nearest points), or keeps its value"},
    {"motion field", "max_extrapolation", "number >= 0", "length", "no limit", R"(file = "displacement.csv"
max_extrapolation = 2e-3)", "A node farther than this beyond the edge is an error"},
    {"motion field", "offset", R"("turn" or "translate")", "", R"("turn")", R"(file = "displacement.csv"
elements = "blade_elements.csv"
offset = "translate")", "The offset between the elements and a node off them turns with the elements, or not"},
    {"motion field modes", "file", "file", "length", "required", R"(modes = [ { file = "bending.csv" } ])", "The mode shape, as `file` of the rule"},
    {"motion field modes", "elements", "file", "", "those of the rule", R"(modes = [ { file = "bending.csv", elements = "blade_elements.csv" } ])",
     "The elements between the points of this mode"},
    {"motion field modes", "solution", "name", "", "the first that fits", R"(modes = [ { file = "modes.cgns", solution = "Mode2" } ])",
     "The `FlowSolution_t` of a CGNS file that holds the shape"},
    {"motion field modes", "amplitude", "number", "1", "1", R"(modes = [ { file = "bending.csv", amplitude = 0.004 } ])", "Multiplies the shape"},
    {"motion field modes", "harmonic", "number", "1", "1", R"(modes = [ { file = "bending.csv", harmonic = 2 } ])", "Cycles per period"},
    {"motion field modes", "frequency", "number", "1/time", "`harmonic` / `period`", R"(modes = [ { file = "bending.csv", frequency = 120 } ])",
     "Cycles per unit of time: the same as `harmonic`, in place of it; needs `period` in [sequence]"},
    {"motion field modes", "phase_deg", "number", "deg", "0", R"(modes = [ { file = "torsion.csv", phase_deg = 90 } ])", "Phase at time 0"},

    {"motion circumferential-slide", "of", "string or list", "", "required", R"(of = "blade")", "The patches (blade) whose motion is taken over"},
    {"motion follow", "of", "string or list", "", "required", R"(of = "blade")", "The patches (blade) whose motion is taken over"},

    {"motion slip", "surface", R"("plane", "revolution" or "baseline")", "", "required", R"(surface = "revolution")",
     "A plane, a surface of revolution about the axis, or whatever shape the patch has in the baseline mesh: a smooth surface "
     "through its nodes ([motion.md](motion.md))"},
    {"motion slip", "plane", "table", "", "fitted to the baseline patch", R"(surface = "plane"
plane = { point = [0, 0, 0], normal = [0, 0, 1] })", "The plane, with `surface = \"plane\"`"},
    {"motion slip", "profile", "list of [axial, radius]", "length", "read off the baseline patch", R"(surface = "revolution"
profile = [[0, 0.5], [1, 0.5]])", "The profile of the wall as it is, with `surface = \"revolution\"`: along the axis, across it, or turning by less than 180 degrees. Nodes "
     "farther off than 1e-3 of the wall's size (its largest radius, or its extent along the axis) are an error; to move the wall onto another "
     "profile, use the rule `contour`"},
    {"motion slip", "crease_angle_deg", "0 < number <= 180", "deg", "46", R"(surface = "baseline"
crease_angle_deg = 30)", "With `surface = \"baseline\"`: faces of the patch that meet at a larger angle meet at a crease, which stays sharp"},
    {"motion slip plane", "point", "[x, y, z]", "length", "required", R"(surface = "plane"
plane = { point = [0, 0, 0], normal = [0, 0, 1] })", "A point of the plane"},
    {"motion slip plane", "normal", "[x, y, z]", "1", "required", R"(surface = "plane"
plane = { point = [0, 0, 0], normal = [0, 0, 1] })", "Across the plane, of any length"},

    {"motion contour", "profile", "list of [axial, radius]", "length", "required", "profile = [[0, 0.5], [0.5, 0.48], [1, 0.5]]",
     "The new profile of the wall, at least as long as the wall: along the axis, across it, or turning by less than 180 degrees"},
    {"motion free", "constraint", R"("none", "axial" or "plane")", "", R"("none")", R"(constraint = "axial")",
     "`axial`: axial position kept; `plane`: nodes stay on the plane of the patch"},

    {"motion sections", "chord", "table of values > -1", "1", "0", "chord = [[0, 0], [0.15, -0.1], [0.5, 0.1], [0.9, -0.1], [1, 0]]",
     "Relative change of the length along the chord line; -0.1 is 10 % shorter, thickness kept"},
    {"motion sections", "scale", "table of values > -1", "1", "0", "scale = 0.05",
     "Relative change of size of the section as a whole"},
    {"motion sections", "thickness", "table of values > -1", "1", "0", "thickness = [[0, 0.1], [1, 0]]",
     "Relative change of thickness about the camber line"},
    {"motion sections", "twist_deg", "table of values between -180 and 180", "deg", "0", "twist_deg = [[0, 0], [1, -3]]",
     "The section turns rigidly; positive: the stagger angle grows"},
    {"motion sections", "stagger_deg", "table of values between -90 and 90", "deg", "0", "stagger_deg = [[0, 0], [1, 5]]",
     "Change of the stagger angle that keeps all axial positions (a shear); typically up to 10"},
    {"motion sections", "sweep", "table of values", "length", "0", "sweep = [[0, 0], [1, 0.01]]",
     "Shift along the chord line, positive towards the trailing edge"},
    {"motion sections", "lean", "table of values", "length", "0", "lean = [[0, 0], [1, 0.01]]",
     "Circumferential shift (wing: across span and flow)"},
    {"motion sections", "bow_deg", "table of values between -90 and 90", "deg", "0", "bow_deg = [[0, 10], [0.5, 0], [1, -10]]",
     "Lean angle of the stacking line; the shift is the integral of its tangent from the root"},
    {"motion sections", "file", "file", "", "none", "file = \"redesign.csv\"",
     "A table with columns: a header line with `span` and any of the names above, separated by commas, semicolons or blanks; cells may be empty between commas"},
    {"motion sections", "pivot", "number", "chord", "0.5", "chord = -0.1\npivot = 0.25",
     "The point of the chord line that chord, scale, twist and stagger leave in place; 0 is the leading edge"},
    {"motion sections", "interpolation", "\"spline\" or \"linear\"", "", "\"spline\"", "chord = -0.1\ninterpolation = \"linear\"",
     "Between stations; both pass through them, the spline without overshoot. Beyond the first and last: their values"},
    {"motion sections", "kind", "\"blade\" or \"wing\"", "", "\"blade\" where [mesh] has an axis, else \"wing\"", "chord = -0.1\nkind = \"wing\"",
     "Blade: sections at constant span fraction between hub and case. Wing: plane sections"},
    {"motion sections", "span", "[x, y, z]", "1", "across the symmetry plane the wing stands on, else its longest extent", "chord = -0.1\nkind = \"wing\"\nspan = [0, 0, 1]",
     "With a wing: from root to tip"},
    {"motion sections", "flow", "[x, y, z]", "1", "[1, 0, 0]", "chord = -0.1\nkind = \"wing\"\nflow = [1, 0, 0]",
     "With a wing: from leading to trailing edge, roughly"},

    {"motion target", "file", "file", "length", "required", "file = \"new_wing.stl\"",
     "The target. By the end of its name: `.stl` (binary or ASCII); `.cgns`, `.cgn`, `.adf`, `.hdf`, `.h5` (structured zones of one node plane, unstructured zones of triangles and quadrilaterals); anything else is text: section profiles, or nodes"},
    {"motion target", "target_patches", "string or list", "", "the file is a surface", "file = \"new_wing.cgns\"\ntarget_patches = [\"wall\"]",
     "CGNS: the file is a volume mesh, and these of its patches are the target (names as in `patches`)"},
    {"motion target", "mapping", "\"automatic\", \"nodes\", \"sections\" or \"projection\"", "", "\"automatic\"", "file = \"new_wing.stl\"\nmapping = \"projection\"",
     "How a node finds its place: see below. `automatic`: sections where the file holds sections; node for node where every patch has a structured grid of its size in the target; projection otherwise"},
    {"motion target", "length_scale", "number > 0", "1", "1", "file = \"new_wing.stl\"\nlength_scale = 1e-3",
     "Multiplies positions: 1e-3 for a file in mm and a mesh in m"},
    {"motion target", "crease_angle_deg", "0 < number < 180", "deg", "40", "file = \"new_wing.stl\"\ncrease_angle_deg = 55",
     "Projection: facets that turn by more than this meet in an edge"},
    {"motion target", "span", "\"x\", \"y\", \"z\", [x, y, z] or \"radius\"", "1", "\"radius\", from the machine axis", "file = \"new_sections.dat\"\nmapping = \"sections\"\nspan = \"z\"",
     "Sections: along what the span is measured"},
    {"motion target", "span_match", "\"fraction\" or \"position\"", "", "\"fraction\"", "file = \"new_sections.dat\"\nmapping = \"sections\"\nspan_match = \"position\"",
     "Sections: first and last section go to the ends of the mesh's span, or positions along the span stay what they are"},
    {"motion target", "flow", "\"x\", \"y\", \"z\" or [x, y, z]", "1", "the machine axis where the span is a radius, else x", "file = \"new_sections.dat\"\nmapping = \"sections\"\nflow = \"x\"",
     "Sections: downstream, to tell leading from trailing edges"},

    {"sequence", "steps", "1 to 99999", "1", "required unless there are `times`", "steps = 32\noutput = \"blade_{step}.cgns\"", "Number of meshes"},
    {"sequence", "period", "number > 0", "time", "1", "steps = 32\nperiod = 8e-3", "Time that `harmonic` and the times in the output refer to"},
    {"sequence", "periods", "number > 0", "period", "1", "steps = 32\nperiods = 0.5",
     "That the steps are spread over: step n of N is at time (n - 1) `periods` `period` / N"},
    {"sequence", "include_end", "true or false", "", "false", "steps = 11\ninclude_end = true",
     "The last step is at the end, step n of N at time (n - 1) `periods` `period` / (N - 1): for motions that are not periodic"},
    {"sequence", "times", "list of numbers", "time", "none", "times = [0, 0.1, 0.5, 1]", "The times of the steps, ascending, in place of `steps`, `periods` and `include_end`"},
    {"sequence", "output", "file", "", "`--output`", "steps = 32\noutput = \"blade_{step}.cgns\"",
     "With `{step}` in its name one file per step (`blade_01.cgns` ...); without, one CGNS file with a series "
     "([formats.md](formats.md#series)). `--output` overrides it. `[mesh] output` is not used"},

    {"conformity", "tolerance", "0 <= number < 1", "mesh size", "1e-9", "tolerance = 1e-8",
     "Displacements that differ by less than this share of the mesh size where patches meet count as equal"},

    {"boundary_layer", "walls", "string or list", "", "every wall that moves", R"(walls = ["blade"])", "The walls whose near field this is"},
    {"boundary_layer", "extent", R"("block" or table)", "", R"("block")", "extent = { layers = 30 }",
     "How far it reaches: up to the first opposite block face, so many cells, or so far from the wall; runs through block and zone limits"},
    {"boundary_layer", "mode", R"("translate", "rotate" or "blend")", "", R"("translate"; unstructured "rotate")", R"(mode = "translate")",
     "translate: nodes take the displacement of the wall node of their grid line or column. Unstructured meshes only: rotate: they turn with the "
     "wall too; blend: the turn fades to none at the end of the column"},
    {"boundary_layer extent", "layers", "whole number > 0", "cells", "none", "extent = { layers = 30 }", "Reach in cells; this or `thickness`"},
    {"boundary_layer extent", "thickness", "number > 0", "length", "none", "extent = { thickness = 2e-3 }", "Reach as a distance; this or `layers`"},

    {"near_field", "walls", "string or list", "", "walls that a rule displaces", R"(walls = ["ball", "rope"])",
     "The walls whose displacement the near field carries"},
    {"near_field", "offset", "number > 0", "length", "from the boundary layer, the wall's edges, the motion and the size of the walls", "offset = 0.02",
     "Everything nearer to the moving walls than this is wrapped and follows them element layer by element layer"},
    {"near_field", "weights", R"("uniform", "inverse-distance", "quality" or "curvature")", "", R"("inverse-distance")", R"(weights = "quality")",
     "How much each node of the layers before counts"},
    {"near_field", "wrap", R"("lattice" or "tube")", "", R"("lattice")", R"(wrap = "tube")",
     "Boxes of a lattice around the walls; or a tube with an O-type background mesh around it, where one fits"},
    {"near_field", "resolution", "whole number, 1 to 200", "cells", "4", "resolution = 8",
     "Cells of the wrap along the longest extent of the walls: how closely it follows them"},

    {"background", "cells", "whole number, 1 to 32", "cells", "4", "cells = 6", "Cells of the background mesh along each cell of the wrap"},
    {"background", "file", "file", "", "made here", "file = \"background.cgns\"",
     "A structured mesh (CGNS or PLOT3D) to carry displacements instead: its hole, bounded by the patches `wrap`, goes around the moving walls; `offset`, "
     "`wrap`, `resolution` and `cells` do not apply then"},
    {"background", "wrap", "string or list", "", R"("wrap")", "file = \"background.cgns\"\nwrap = [\"inner\"]", "With `file`: its patches around the moving walls"},
    {"background", "outer", "string or list", "", R"("outer")", "file = \"background.cgns\"\nouter = [\"box_*\"]",
     "With `file`: its patches that stay, or move as the nearest prescribed boundary; others slide"},
    {"background", "law", R"("linear", "c1" or "c2")", "", R"("linear")", R"(law = "c1")",
     "How displacements fall off along the grid lines of the background mesh, as `law` in [volume]"},

    {"volume", "law", R"("linear", "c1" or "c2")", "", R"("linear")", R"(law = "c1")", "How displacement varies along a grid line"},
    {"volume", "priority", "list of tables", "", "boundary, quality, aspect-ratio", R"(priority = [ { rule = "boundary", order = ["wall", "periodic"] }, { rule = "quality" } ])",
     "Which chains come first; each breaks the ties of the one before"},
    {"volume priority", "rule", R"("boundary", "quality" or "aspect-ratio")", "", "required", R"(priority = [ { rule = "quality" } ])", "What is compared"},
    {"volume priority", "order", "list", "", R"(["wall", "periodic", "inflow", "outflow"])", R"(priority = [ { rule = "boundary", order = ["wall", "periodic"] } ])",
     "With `boundary`: kinds from first to last, of wall, periodic, inflow, outflow, symmetry, farfield, degenerate, connection, other"},

    {"guard", "max_loss", "0 < number <= 1", "1", "0.9", "max_loss = 0.5", "Largest share that a cell may lose of the 3x3x3 determinant or of the smallest angle that it has in the baseline"},
    {"guard", "max_skewness", "0 < number <= 1", "1", "0.98", "max_skewness = 0.95", "Largest equiangle skewness that passes"},
    {"guard", "min_angle_deg", "0 <= number < 90", "deg", "2", "min_angle_deg = 5.0", "Smallest angle that passes"},
    {"guard", "min_determinant", "-1 <= number < 1", "1", "0.05", "min_determinant = 0.1", "Smallest 3x3x3 determinant that passes"},
    {"guard", "quality", R"("auto", "full" or "fast")", "", R"("auto")", R"(quality = "full")", "`full`: all measures, baseline and morphed; `fast`: a verdict (what is inverted or beyond a limit, smallest determinant and angle); `auto`: `fast` above a million cells; always `full` where `[output]` `quality` is set; `--quality` overrides it"},
    {"guard", "steps", "1 to 64", "1", "4", "steps = 8", "Unstructured meshes: where elements are inverted after one step, the motion is made in 2, 3, ... steps up to this number, each planned on the mesh before it, until none is"},
    {"guard", "write_inverted", "true or false", "", "false", "write_inverted = true", "Write the mesh even if cells are inverted that were not in the baseline"},

    {"output", "displacement", "true or false", "", "false", "displacement = true", "Displacement of the nodes as a solution of the output mesh (CGNS)"},
    {"output", "quality", "true or false", "", "false", "quality = true", "Quality measures of the cells as a solution of the output mesh (CGNS)"},
    {"output", "report", "file", "", "none", R"(report = "report.json")", "Report as JSON; `--report` overrides it"},
    {"output", "stages", "folder", "", "none", R"(stages = "stages")",
     "Of an unstructured morph: wrap.cgns, background.cgns and background_morphed.cgns, and the morphed mesh with its regions, layers and displacements as regions.cgns"},

    {"wheel", "output", "file", "", "`--output`", R"(output = "rotor_wheel.cgns")", "The mesh of the wheel (CGNS); `--output` overrides it. Never the input"},
    {"wheel", "families", R"("shared" or "suffixed")", "", R"("shared")", R"(families = "suffixed")", "Family names as they are, or with the passage's suffix"},
    {"wheel", "passages", "whole number > 0", "1", "all of 360 degrees", "passages = 3", "How many are made; the ends of fewer stay periodic"},
    {"wheel", "sequence", "list of blade names", "", "every blade as [[motion]] says", R"(sequence = ["A", "B"]
blade = [ { name = "A" }, { name = "B", factor = 1.05 } ])",
     "Which blade stands in which passage, first passage first; repeated, so the passages are a multiple of its length"},
    {"wheel", "factors", "list of numbers", "1", "1", "factors = [1, 1.02, 0.97]", "On the motion of the blades, as `factor` of [[wheel.blade]]; per passage, repeated likewise"},
    {"wheel", "zones", "string or list", "", "every periodic row", R"(zones = ["rotor*"])",
     "The row that passages, sequence and factors are for: zone names or globs that hit one of its zones"},
    {"wheel", "row", "list of tables", "", "one row", R"([[wheel.row]]
zones = ["rotor*"]
passages = 3)", "Rows of a mesh of several, each with keys of its own"},
    {"wheel", "blade", "list of tables", "", "none", R"([[wheel.blade]]
name = "A")", "The blades that `sequence` names"},
    {"wheel row", "zones", "string or list", "", "required", R"([[wheel.row]]
zones = ["rotor*"])", "Zone names or globs that hit one zone of the row"},
    {"wheel row", "passages", "whole number > 0", "1", "all of 360 degrees", R"([[wheel.row]]
zones = ["rotor*"]
passages = 3)", "As in [wheel]"},
    {"wheel row", "sequence", "list of blade names", "", "every blade as [[motion]] says", R"([[wheel.row]]
zones = ["rotor*"]
sequence = ["A"]
[[wheel.blade]]
name = "A")", "As in [wheel]"},
    {"wheel row", "factors", "list of numbers", "1", "1", R"([[wheel.row]]
zones = ["rotor*"]
factors = [1, 1.02])", "As in [wheel]"},
    {"wheel blade", "name", "string", "", "required", R"([[wheel.blade]]
name = "A")", "What `sequence` calls it"},
    {"wheel blade", "factor", "number", "1", "1", R"([[wheel.blade]]
name = "B"
factor = 1.05)", "Multiplies what the explicit rules do ([wheel.md](wheel.md#factors))"},
    {"wheel blade", "motion", "list of tables", "", "none", R"([[wheel.blade]]
name = "C"
[[wheel.blade.motion]]
patches = ["blade"]
rule = "rigid"
translation = [0, 0.001, 0])", "Tables as [[motion]], of rule `fixed`, `rigid`, `formula` or `field`, in place of the [[motion]] rule of such "
     "a kind, or `sections` or `target`, that has the same patches"},
    // clang-format on
});

/// '|' ends a cell of a Markdown table.
std::string cell(std::string_view text, bool code) {
  std::string out;
  for (char const c : text) {
    if (c == '|') out += '\\';
    if (c == '\n')
      out += code ? "`<br>`" : " ";
    else
      out += c;
  }
  return code ? "`" + out + "`" : out;
}

}  // namespace

std::span<CaseKey const> case_keys() { return list; }

std::string case_key_table(std::string_view table) {
  std::string out = "| key | type | unit | default | example | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
  for (auto const& k : list)
    if (k.table == table)
      out += "| `" + std::string(k.key) + "` | " + cell(k.type, false) + " | " + cell(k.unit, false) + " | " +
             cell(k.initial, false) + " | " + cell(k.example, true) + " | " + cell(k.meaning, false) + " |\n";
  return out;
}

}  // namespace gridmorph
