#include <generators/passage_motion.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

void write_displacement_csv(std::string const& path, Mesh const& mesh, std::vector<std::string> const& families,
                            std::function<Vec3(Vec3 const&)> const& displacement) {
  std::vector<std::array<double, 3>> points;
  for (Patch const& patch : mesh.patches) {
    if (std::find_first_of(patch.families.begin(), patch.families.end(), families.begin(), families.end()) ==
        patch.families.end())
      continue;
    IndexRange const& r = patch.range;
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) {
          Vec3 const p = mesh.coordinates[mesh.zones[patch.zone].node({i, j, k})];
          points.push_back({p.x, p.y, p.z});
        }
  }
  if (points.empty())
    throw MeshError("displacement file '" + path + "': no patch of " + mesh.source + " has the family '" +
                    families.front() + "'");
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());

  auto const failed = [&] {
    return MachineError("displacement file '" + path + "' cannot be written: " + std::strerror(errno));
  };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "w"), &std::fclose);
  if (!file) throw failed();
  bool good = std::fputs("x,y,z,dx,dy,dz\n", file.get()) >= 0;
  for (auto const& [x, y, z] : points) {
    Vec3 const d = displacement({x, y, z});
    good = std::fprintf(file.get(), "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", x, y, z, d.x, d.y, d.z) > 0 && good;
  }
  good = std::fclose(file.release()) == 0 && good;
  if (!good) throw failed();
}

}  // namespace gridmorph
