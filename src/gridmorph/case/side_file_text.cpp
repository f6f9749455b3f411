#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/case/open_patches.hpp>
#include <gridmorph/case/side_file.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace gridmorph {

namespace {

std::string quoted(std::string const& text) {
  std::string out = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04X}", int(static_cast<unsigned char>(c)));
    else
      out += c;
  }
  return out + "\"";
}

std::string vector_text(Vec3 const& v) { return fmt::format("[{}, {}, {}]", v.x + 0.0, v.y + 0.0, v.z + 0.0); }

std::string range_text(IndexRange const& r) {
  return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", r.begin[0] + 1, r.begin[1] + 1, r.begin[2] + 1, r.end[0], r.end[1],
                     r.end[2]);
}

/// From the node that goes with the first of the own range to the one that goes with the last.
std::string donor_range_text(Interface1to1 const& face) {
  Index3 const a = face.to_donor(face.range.begin);
  Index3 const b = face.to_donor(Index3{face.range.end[0] - 1, face.range.end[1] - 1, face.range.end[2] - 1});
  return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", a[0] + 1, a[1] + 1, a[2] + 1, b[0] + 1, b[1] + 1, b[2] + 1);
}

std::string transform_text(Orientation const& o) {
  return fmt::format("[{}, {}, {}]", o.sign[0] * (o.axis[0] + 1), o.sign[1] * (o.axis[1] + 1),
                     o.sign[2] * (o.axis[2] + 1));
}

bool same(Periodic const& a, Periodic const& b) {
  return a.rotation_angle_rad == b.rotation_angle_rad && a.rotation_center == b.rotation_center &&
         a.translation == b.translation && a.declared.translation == b.declared.translation;
}

/// Axis and angle of a declared rotation, whatever the axis.
std::string periodic_text(Periodic const& p, std::string const& name) {
  std::string out = fmt::format("\n[[periodic]]\nname = {}\n", quoted(name));
  auto const turn = as_turn(p.declared, std::numeric_limits<double>::infinity());
  if (!turn) return out + "translation = " + vector_text(p.translation) + "\n";
  double angle = turn->angle_rad;
  Vec3 direction = turn->direction;
  // About x, y or z the angles say it without the round-off of the matrix.
  Vec3 const w = p.rotation_angle_rad;
  if (double const plain = norm(w); std::fabs(plain - angle) < 1e-9) {
    angle = plain;
    direction = (1 / plain) * w;
  }
  return out + fmt::format("axis = {{ origin = {}, direction = {} }}\nangle_deg = {}\n", vector_text(p.rotation_center),
                           vector_text(direction), angle * 180 / std::numbers::pi);
}

}  // namespace

std::string side_file_text(Mesh const& mesh, FoundInterfaces const& found, std::string const& existing) {
  std::string text = existing;
  if (existing.empty()) {
    text =
        fmt::format("# Patches and interfaces of {}. Nodes are counted from 1; docs/formats.md describes the keys.\n",
                    std::filesystem::path(mesh.source).filename().string());
    if (!mesh.file_variant.empty()) text += fmt::format("format = {}\n", quoted(mesh.file_variant));
  } else if (text.back() != '\n') {
    text += '\n';
  }
  for (auto const& note : found.notes) text += "# " + note + "\n";

  std::vector<Periodic> periodics;
  auto const number_of = [&](Periodic const& p) {
    for (std::size_t n = 0; n < periodics.size(); ++n)
      if (same(periodics[n], p)) return n + 1;
    periodics.push_back(p);
    text += periodic_text(p, fmt::format("found {}", periodics.size()));
    return periodics.size();
  };
  Mesh rest = mesh;  // shares the coordinates
  auto const zone = [&](int z) {
    return mesh.file_variant.empty() ? quoted(mesh.zones[z].name) : std::to_string(z + 1);
  };
  for (auto const& face : found.interfaces) {
    std::string const periodic =
        face.periodic ? fmt::format("periodic = \"found {}\"\n", number_of(*face.periodic)) : std::string();
    text += fmt::format(
        "\n[[interface]]\nname = {}\nzone = {}\nrange = {}\ndonor_zone = {}\ndonor_range = {}\ntransform = {}\n{}",
        quoted(face.name), zone(face.zone), range_text(face.range), zone(face.donor_zone), donor_range_text(face),
        transform_text(face.to_donor.orientation), periodic);
    rest.interfaces.push_back(face);
  }

  TopologyOptions everything;
  everything.open_faces = "open";
  everything.matching_tolerance = mesh.size();  // what was found is good enough to say what is left
  Problems ignored;
  std::size_t const before = rest.patches.size();
  complete_patches(rest, connect(rest, everything, ignored), everything);
  if (rest.patches.size() > before)
    text +=
        "\n# What is left is the boundary: give each patch its name, family and kind (wall, inflow, outflow, "
        "symmetry,\n"
        "# farfield, other).\n";
  auto const names = names_of_open_patches(rest, before);
  for (std::size_t p = before; p < rest.patches.size(); ++p) {
    Patch const& patch = rest.patches[p];
    text += fmt::format("\n[[patch]]\nname = {}\nkind = \"{}\"\nzone = {}\nrange = {}\n", quoted(names[p - before]),
                        to_string(patch.kind), zone(patch.zone), range_text(patch.range));
  }
  return text;
}

}  // namespace gridmorph
