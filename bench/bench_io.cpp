// Reading and writing meshes against a plain copy of the same file, all in the page cache.
//
//   copy_file       the whole file, by the system's own means: what write_morphed cannot beat
//   read_mesh       file -> Mesh
//   write_morphed   file and morphed coordinates -> new file
//
// Every output is a new file: the one of the iteration before is removed while the clock stands. "bytes/s" counts the
// bytes of the file once. What the disk itself does later is not measured.
#include "bench.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <unistd.h>

namespace gridmorph::bench {
namespace {

namespace fs = std::filesystem;

/// A folder that is gone with all in it when the benchmark ends.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(fs::temp_directory_path() / ("gridmorph-bench-io-" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(TemporaryFolder const&) = delete;
  TemporaryFolder& operator=(TemporaryFolder const&) = delete;
  [[nodiscard]] std::string file(char const* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

struct Storage {
  FileFormat format;
  bool single_precision;
};

std::string name_of(Storage const& s) {
  return std::string(s.format == FileFormat::cgns_hdf5 ? "hdf5" : "adf") + (s.single_precision ? "/float" : "/double");
}

/// Twelve equal boxes in a row, each face a wall, of about n nodes together.
Mesh boxes(std::int64_t n, bool single_precision) {
  constexpr int zones = 12;
  Mesh mesh;
  mesh.source = "bench_io";
  int const m = std::max(2, int(std::cbrt(double(n) / zones)));
  for (int z = 0; z < zones; ++z) {
    mesh.add_zone("box " + std::to_string(z + 1), {m, m, m});
    mesh.zones.back().single_precision = single_precision;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        IndexRange range{{0, 0, 0}, {m, m, m}};
        range.begin[axis] = side == 0 ? 0 : m - 1;
        range.end[axis] = range.begin[axis] + 1;
        mesh.patches.push_back({std::string(face_name(axis, side)), "BCWall", PatchKind::wall, {}, z, range});
      }
  }
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (Index node = 0; node < mesh.n_nodes(); ++node) {
    int const z = mesh.zone_of(node);
    auto const p = mesh.zones[z].index(node);
    mesh.coordinates.set(node, {z + double(p[0]) / (m - 1), double(p[1]) / (m - 1), double(p[2]) / (m - 1)});
  }
  return mesh;
}

/// Runs work(input, output, mesh), timed, on a file of the mesh.
template <class Work>
void run(benchmark::State& state, Storage const& storage, Work const& work) {
  TemporaryFolder const folder;
  std::string const input = folder.file("in.cgns"), output = folder.file("out.cgns");
  Mesh const mesh = boxes(state.range(0), storage.single_precision);
  write_mesh(input, mesh, {storage.format, 3});
  for (auto _ : state) {
    fs::remove(output);
    state.SetIterationTime(seconds(Kokkos::DefaultHostExecutionSpace(), [&] { work(input, output, mesh); }));
  }
  set_rates(state, mesh.n_nodes(), double(fs::file_size(input)) / double(mesh.n_nodes()));
}

template <class Work>
void register_for_files(std::string const& name, Work const& work) {
  for (FileFormat const format : {FileFormat::cgns_hdf5, FileFormat::cgns_adf})
    for (bool const single : {false, true}) {
      Storage const storage{format, single};
      benchmark::RegisterBenchmark((name + "/" + name_of(storage)).c_str(),
                                   [=](benchmark::State& state) { run(state, storage, work); })
          ->ArgName("nodes")
          ->Arg(smoke_nodes)
          ->Arg(cache_nodes)
          ->Arg(10'000'000)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
}

}  // namespace

void register_all() {
  register_for_files("copy_file", [](std::string const& input, std::string const& output, Mesh const&) {
    fs::copy_file(input, output);
  });
  register_for_files("read_mesh", [](std::string const& input, std::string const&, Mesh const&) {
    benchmark::DoNotOptimize(read_mesh(input));
  });
  register_for_files("write_morphed", [](std::string const& input, std::string const& output, Mesh const& mesh) {
    write_morphed(input, output, mesh, mesh.coordinates);
  });
}

}  // namespace gridmorph::bench
