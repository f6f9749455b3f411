#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/io/morphed_file.hpp>
#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/write_series.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

constexpr std::size_t name_length = 32;  // of names in pointers, padded with blanks (SIDS)
constexpr std::array<char const*, 3> coordinate_names{"CoordinateX", "CoordinateY", "CoordinateZ"};

/// "GridCoordinates_007" where there are at most 999 steps.
std::string grid_name(std::size_t step, std::size_t steps) {
  std::string number = std::to_string(step + 1);
  return "GridCoordinates_" + std::string(std::to_string(steps).size() - number.size(), '0') + number;
}

/// A series of several steps is the user's, and cannot go on beside another one; solvers write one of a single step
/// with steady solutions, which is replaced.
void refuse_series(cgns::File const& file, cgns::Layout const& layout, std::size_t steps) {
  Problems problems;
  auto const refuse = [&](cgns::Node const& node) {
    problems.add(file.path() + ", node " + node.path +
                 ": the file holds a time series already; take it out first, or write one file per step");
  };
  std::set<cgns::Node const*> bases;
  for (auto const& zone : layout.zones) {
    bases.insert(zone.base);
    for (std::size_t s = 0; s < steps; ++s)
      if (auto const* node = zone.node->child(grid_name(s, steps))) refuse(*node);
  }
  for (auto const* base : bases)
    for (auto const* node : base->all("BaseIterativeData_t"))
      if (auto const number = file.integers(*node); number.empty() || number[0] > 1) refuse(*node);
  problems.throw_if_any<IoError>();
}

void check_input(std::string const& input, Mesh const& mesh, std::size_t steps) {
  cgns::File const file(input, cgns::File::Mode::read);
  auto const tree = file.tree();
  auto const layout = cgns::zones_of(file, tree, mesh);
  cgns::check_same_mesh(file, layout, mesh);
  refuse_series(file, layout, steps);
}

}  // namespace

/// What a series is written into.
struct SeriesWriter::Impl {
  Impl(std::string output, Mesh const& m, std::size_t n) : name(std::move(output)), mesh(m), steps(n) {
    if (steps == 0) throw MeshError(name + ": a series needs at least one step");
  }
  virtual ~Impl() = default;

  /// `mesh` where the one of the caller left nodes to its file.
  struct AllNodes {
    Mesh const& of_caller;
    NodesOfFile file;
    Mesh mesh;
  };

  void add(Coordinates const& of_caller) {
    if (all && of_caller.size() == all->of_caller.n_nodes())
      add_all(with_all_nodes(all->of_caller, all->file, of_caller));
    else
      add_all(of_caller);
  }
  void add_all(Coordinates const& morphed) {
    if (written == steps)
      throw MeshError(name + ": more steps than the " + std::to_string(steps) + " times of the series");
    if (morphed.size() != mesh.n_nodes())
      throw MeshError("the array of morphed coordinates has " + std::to_string(morphed.size()) +
                      " values, but the mesh asks for " + std::to_string(mesh.n_nodes()));
    Problems problems;
    io::check_finite(mesh, morphed, "step " + std::to_string(written + 1) + " of the series", problems);
    problems.throw_if_any<MeshError>();
    write_step(mesh.is_structured() ? morphed : in_file_order(mesh, morphed));
    ++written;
  }
  void add_zone(int zone, std::array<double const*, 3> const& values) {
    if (written == steps)
      throw MeshError(name + ": more steps than the " + std::to_string(steps) + " times of the series");
    if (zones_of_step.empty()) zones_of_step.assign(mesh.zones.size(), 0);
    auto const& own = mesh.zones.at(zone);
    std::string const what = "zone '" + own.name + "' of step " + std::to_string(written + 1);
    if (std::exchange(zones_of_step[zone], 1) != 0) throw MeshError(name + ": " + what + " is written twice");
    for (auto const* component : values)
      if (!std::all_of(component, component + own.size(), [](double v) { return std::isfinite(v); }))
        throw MeshError(name + ": " + what + " has coordinates that are not finite");
    write_zone(std::size_t(zone), values);
    if (std::find(zones_of_step.begin(), zones_of_step.end(), 0) != zones_of_step.end()) return;
    zones_of_step.clear();
    ++written;
  }
  void finish() {
    if (written < steps)
      throw MeshError(name + ": " + std::to_string(written) + " of " + std::to_string(steps) +
                      " steps of the series were written");
    put_in_place();
  }

  std::string name;
  std::unique_ptr<AllNodes> all;
  Mesh const& mesh;
  std::size_t steps;
  std::size_t written = 0;
  std::vector<char> zones_of_step;  ///< those that add_zone() has had of the step to come; empty: none

 private:
  virtual void write_zone(std::size_t /*zone*/, std::array<double const*, 3> const& /*values*/) {
    throw IoError(name + ": a series is written zone by zone into CGNS files alone");
  }
  virtual void write_step(Coordinates const& ordered) = 0;
  virtual void put_in_place() = 0;
};

namespace {

/// A series in one CGNS file.
struct CgnsSeries final : SeriesWriter::Impl {
  io::OutputFile target;
  std::optional<cgns::File> file;
  cgns::Node tree;
  cgns::Layout layout;
  std::vector<double> plane;
  std::vector<float> single;

  CgnsSeries(std::string const& input, std::string const& output, Mesh const& m, std::vector<double> const& times)
      : Impl(output, m, times.size()), target(output) {
    target.copy_from(input);
    target.reserve(bytes_needed());
    file.emplace(target.path(), cgns::File::Mode::modify);
    tree = file->tree();
    layout = cgns::zones_of(*file, tree, mesh);
    add_iterative_data(times);
  }

  [[nodiscard]] std::uint64_t bytes_needed() const {
    std::uint64_t const zones = mesh.zones.size(), nodes_per_step = 4 * zones, once = 4 * zones + 4;
    std::uint64_t nodes = 0;  // zones may share theirs
    for (Zone const& zone : mesh.zones) nodes += std::uint64_t(zone.size());
    return steps * (cgns::File::bytes_per_node * nodes_per_step + 3 * sizeof(double) * nodes) +
           cgns::File::bytes_per_node * once + steps * name_length * zones;
  }

  void add_iterative_data(std::vector<double> const& times) {
    std::vector<std::int32_t> number(steps);
    std::iota(number.begin(), number.end(), 1);
    auto const count = std::int32_t(steps);
    std::set<cgns::Node const*> done;
    std::string names;
    for (std::size_t s = 0; s < steps; ++s) {
      names += grid_name(s, steps);
      names.resize((s + 1) * name_length, ' ');
    }
    for (auto const& zone : layout.zones) {
      for (auto const* old : zone.node->all("ZoneIterativeData_t")) file->remove(*zone.node, *old);
      if (done.insert(zone.base).second) {
        for (auto const* old : zone.base->all("BaseIterativeData_t")) file->remove(*zone.base, *old);
        double const base_id = file->id(*zone.base);
        double const base = file->create(base_id, "BaseIterativeData", "BaseIterativeData_t", "I4", {1}, &count);
        file->create(base, "TimeValues", "DataArray_t", "R8", {Index(steps)}, times.data());
        file->create(base, "IterationValues", "DataArray_t", "I4", {Index(steps)}, number.data());
        if (zone.base->labelled("SimulationType_t") == nullptr)
          file->create_text(base_id, "SimulationType", "SimulationType_t", "TimeAccurate");
      }
      double const iterative = file->create(file->id(*zone.node), "ZoneIterativeData", "ZoneIterativeData_t");
      file->create(iterative, "GridCoordinatesPointers", "DataArray_t", "C1", {Index(name_length), Index(steps)},
                   names.data());
    }
  }

  void write_step(Coordinates const& ordered) override {
    auto const arrays = io::components(ordered);
    for (std::size_t z = 0; z < layout.zones.size(); ++z) {
      Index const first = mesh.zones[z].first_node;
      write_zone(z, {arrays[0] + first, arrays[1] + first, arrays[2] + first});
    }
  }

  void write_zone(std::size_t z, std::array<double const*, 3> const& values) override {
    auto const& place = layout.zones[z];
    double const grid = file->create(file->id(*place.node), grid_name(written, steps), "GridCoordinates_t");
    std::vector<Index> sizes(place.extent.begin(), place.extent.begin() + place.index_dimension);
    for (int c = 0; c < 3; ++c) {
      if (place.array[c] == nullptr) continue;
      auto const put = [&](double const* of_file) { write(grid, place, c, sizes, of_file); };
      if (mesh.is_structured())
        cgns::with_file_nodes(place, mesh.zones[z], values[c], plane, put);
      else
        put(values[c]);
    }
  }

  void put_in_place() override {
    file->close();
    file.reset();
    cgns::check_file(target.path());
    target.commit();
  }

  void write(double grid, cgns::ZoneLayout const& place, int c, std::vector<Index> const& sizes, double const* values) {
    if (!place.single_precision[c]) {
      file->create(grid, coordinate_names[c], "DataArray_t", "R8", sizes, values);
      return;
    }
    single.assign(values, values + place.nodes_in_file());
    file->create(grid, coordinate_names[c], "DataArray_t", "R4", sizes, single.data());
  }
};

/// Folders of times in a case of OpenFOAM.
struct FoamSeries final : SeriesWriter::Impl {
  foam::TimeFolders folders;

  FoamSeries(std::string const& input, std::string const& output, Mesh const& m, std::vector<double> const& times)
      : Impl(output, m, times.size()), folders(input, output, m, times) {}
  void write_step(Coordinates const& ordered) override { folders.add(ordered); }
  void put_in_place() override { folders.commit(); }
};

}  // namespace

SeriesWriter::SeriesWriter(std::string const& input, std::string const& output, Mesh const& mesh,
                           std::vector<double> const& times) {
  if (mesh.file_order.left_out > 0) {
    NodesOfFile file = io::nodes_of_file(input, mesh);
    Mesh whole = with_all_nodes(mesh, file);
    auto all = std::make_unique<Impl::AllNodes>(Impl::AllNodes{mesh, std::move(file), std::move(whole)});
    impl_ = std::move(SeriesWriter(input, output, all->mesh, times).impl_);
    impl_->all = std::move(all);
    return;
  }
  MeshFormat const format = mesh_format(input);
  if (!mesh.is_structured() && !holds_series(format))
    throw IoError(output + ": " + std::string(to_string(format)) +
                  " files hold one mesh; write one file per step, or use a CGNS mesh");
  if (format == MeshFormat::openfoam) {
    impl_ = std::make_unique<FoamSeries>(input, output, mesh, times);
    return;
  }
  check_input(input, mesh, times.size());
  impl_ = std::make_unique<CgnsSeries>(input, output, mesh, times);
}

SeriesWriter::~SeriesWriter() = default;
SeriesWriter::SeriesWriter(SeriesWriter&&) noexcept = default;

void SeriesWriter::add(Coordinates const& morphed) { impl_->add(morphed); }

void SeriesWriter::add_zone(int zone, double const* x, double const* y, double const* z) {
  impl_->add_zone(zone, {x, y, z});
}

void SeriesWriter::commit() { impl_->finish(); }

}  // namespace gridmorph
