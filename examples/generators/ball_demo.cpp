#include <generators/ball_counts.hpp>
#include <generators/ball_demo.hpp>
#include <generators/text_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph {

namespace {

double radians(BallSwing const& swing) { return swing.angle_deg * std::numbers::pi / 180; }

}  // namespace

Vec3 ball_displacement(BallOptions const& options, BallSwing const& swing, Vec3 const& point) {
  double const angle = radians(swing), bend = swing.bend * options.radius, below = rope_end(options) - point.z;
  if (angle == 0) return {};
  double const phi = angle * std::min(below / bend, 1.0), rho = bend / angle, s = std::max(below - bend, 0.0);
  return {rho * (1 - std::cos(phi)) + s * std::sin(phi) + point.x * (std::cos(phi) - 1), 0,
          below - rho * std::sin(phi) - s * std::cos(phi) + point.x * std::sin(phi)};
}

void check_swing(BallOptions const& o, BallSwing const& swing) {
  constexpr double gap = 0.5;
  Problems problems;
  if (!(swing.bend > 0 && swing.bend <= o.rope_length))
    problems.add(fmt::format("ball: the bend is {} radii long; it must be positive and within the rope's {}",
                             swing.bend, o.rope_length));
  if (!(std::abs(swing.angle_deg) <= 120))
    problems.add(fmt::format("ball: the angle is {} degrees; it must lie within -120 and 120", swing.angle_deg));
  problems.throw_if_any<ConfigError>();
  Vec3 const to = (1 / o.radius) * ball_displacement(o, swing, {0, 0, 0});
  double const reach = 1 + gap;
  // The jib ends above the rope's axis, a tube's half width behind it; the way behind is free up to the box.
  bool const free = to.x + reach <= o.mast_distance && to.x - reach >= -o.behind && to.z - reach >= -o.below &&
                    to.z + reach <= 1 + o.rope_length;
  if (!free)
    throw ConfigError(fmt::format(
        "ball: turned by {} degrees, its centre is at x = {:.3g}, z = {:.3g} radii and it comes closer than {} "
        "radii to the crane or the box; swing less far, or make rope_length smaller or mast_distance larger",
        swing.angle_deg, to.x, to.z, gap));
}

std::string ball_case_file(BallOptions const& options, BallSwing const& swing, BallFiles const& files) {
  double const angle = radians(swing), bend = swing.bend * options.radius;
  std::string text = fmt::format(
      "# The ball swings towards the mast of the crane by {} degrees (paper, Figures 16 to 24). Paths are relative to "
      "this file.\n"
      "\n"
      "[mesh]\n"
      "input  = \"{}\"\n"
      "output = \"{}\"\n"
      "\n"
      "[[motion]]                          # the rope bends below the jib, the ball turns with its lower end\n"
      "patches = [\"ball\", \"rope\"]\n",
      swing.angle_deg, files.mesh.filename().string(), files.morphed.filename().string());
  if (angle == 0)
    text += "rule    = \"fixed\"\n";
  else
    text += fmt::format(
        "rule    = \"formula\"\n"
        "dx      = \"rho * (1 - cos(angle * min((top - z) / bend, 1))) + max(top - z - bend, 0) * sin(angle * min((top "
        "- z) / bend, 1))"
        " + x * (cos(angle * min((top - z) / bend, 1)) - 1)\"\n"
        "dz      = \"top - z - rho * sin(angle * min((top - z) / bend, 1)) - max(top - z - bend, 0) * cos(angle * "
        "min((top - z) / bend, 1))"
        " + x * sin(angle * min((top - z) / bend, 1))\"\n"
        "\n"
        "[motion.constants]\n"
        "angle   = {:.17g}\n"
        "top     = {:.17g}                   # z of the jib\n"
        "bend    = {:.17g}                   # length of the rope that bends\n"
        "rho     = {:.17g}                   # radius that it bends to: bend / angle\n",
        angle, rope_end(options), bend, bend / angle);
  text +=
      "\n"
      "[[motion]]\n"
      "patches = [\"crane\"]\n"
      "rule    = \"fixed\"\n"
      "\n"
      "[boundary_layer]                    # the layers turn with their wall\n"
      "walls   = [\"ball\", \"rope\"]\n"
      "mode    = \"rotate\"\n"
      "\n"
      "[guard]                             # its flattest tetrahedra begin with 0.01 to 0.04\n"
      "min_determinant = 0.001\n"
      "\n"
      "[output]\n"
      "displacement = true\n"
      "quality      = true\n"
      "stages       = \"stages\"            # wrap, regions and layers, background mesh: to look at\n";
  return text;
}

BallFiles ball_files(std::filesystem::path const& folder) {
  return {folder / "ball.cgns", folder / "swing.toml", folder / "ball_swing.cgns"};
}

BallFiles write_ball_demo(std::filesystem::path const& folder, BallOptions const& options, BallSwing const& swing) {
  check_swing(options, swing);
  Mesh const mesh = make_ball(options);
  make_folder(folder);
  BallFiles files = ball_files(folder);
  write_mesh(files.mesh.string(), mesh);
  write_text_file(files.case_file, ball_case_file(options, swing, files), "case file");
  return files;
}

}  // namespace gridmorph
