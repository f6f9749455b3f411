#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/extrude.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/read_solution.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

using cgns::Node;

/// How the values of a zone lie in an array of the file.
struct StoredZone {
  std::array<Index, 3> core{1, 1, 1};  ///< values of the zone
  std::array<Index, 3> low{0, 0, 0}, high{0, 0, 0};

  [[nodiscard]] Index size() const {
    Index out = 1;
    for (int a = 0; a < 3; ++a) out *= low[a] + core[a] + high[a];
    return out;
  }
  /// The values of the zone out of all that are stored: without rind planes.
  [[nodiscard]] std::vector<double> inner(std::vector<double> const& all) const {
    std::vector<double> out;
    out.reserve(core[0] * core[1] * core[2]);
    Index const ni = low[0] + core[0] + high[0], nj = low[1] + core[1] + high[1];
    for (Index k = 0; k < core[2]; ++k)
      for (Index j = 0; j < core[1]; ++j) {
        auto const line = all.begin() + (low[0] + ni * (low[1] + j + nj * (low[2] + k)));
        out.insert(out.end(), line, line + core[0]);
      }
    return out;
  }
};

class SolutionReader {
 public:
  SolutionReader(std::string const& path, Mesh const& mesh, SolutionWanted const& wanted)
      : file_(path, cgns::File::Mode::read), mesh_(mesh), wanted_(wanted), chosen_(wanted.solution) {}

  FlowSolution read() {
    Node const tree = file_.tree();
    Problems problems;
    layout_ = mesh_.is_structured() ? find_zones(file_, tree, problems, wanted_.leave_out)
                                    : find_unstructured_zones(file_, tree, problems, wanted_.leave_out);
    problems.throw_if_any<IoError>();
    solutions_ = io::zone_solutions(file_, layout_);
    for (std::size_t z = 0; z < mesh_.zones.size(); ++z) read_zone(int(z));
    problems_.throw_if_any<IoError>();
    // What some zones lack is no variable of the mesh.
    std::erase_if(out_.values, [&](auto const& v) { return zones_with_[v.first] != mesh_.zones.size(); });
    out_.source = file_.path() + ": solution '" + chosen_ + "'";
    return std::move(out_);
  }

 private:
  void problem(Zone const& zone, std::string const& what) {
    problems_.add(file_.path() + ": zone '" + zone.name + "'" + what);
  }

  void read_zone(int z) {
    Zone const& zone = mesh_.zones[z];
    auto const at = std::find_if(layout_.zones.begin(), layout_.zones.end(),
                                 [&](cgns::ZoneLayout const& one) { return one.name == zone.name; });
    if (at == layout_.zones.end()) {
      std::vector<std::string> names;
      for (auto const& one : layout_.zones) names.push_back(one.name);
      constexpr std::size_t most = 12;
      return problem(zone, " of the mesh is not there; the zones are " + quote_list(names, most));
    }
    Index const n_nodes = mesh_.is_structured() && at->flat_axis >= 0 ? zone.size() / 2 : zone.size();
    // Of a file that nodes were left to only the last place is known that the mesh has.
    if (mesh_.file_order.left_out > 0 ? at->nodes_in_file() <= last_place(zone) : at->nodes_in_file() != n_nodes)
      return problem(zone, " has " + std::to_string(at->nodes_in_file()) + " nodes, but the mesh has " +
                               std::to_string(n_nodes) + " there; give a solution on this mesh");
    Node const* solution = choose(zone, solutions_[at - layout_.zones.begin()]);
    if (solution != nullptr) read_arrays(zone, *at, *solution);
  }

  /// Where the node of a zone stands that comes last in the file, counted from the first of the zone.
  [[nodiscard]] Index last_place(Zone const& zone) const {
    auto const begin = mesh_.file_order.node.begin() + std::ptrdiff_t(zone.first_node);
    auto const end = begin + std::ptrdiff_t(zone.size());
    return begin == end ? -1 : Index(*std::max_element(begin, end)) - zone.first_node;
  }

  /// The solution by its name; in the first zone perhaps the best one.
  Node const* choose(Zone const& zone, io::ZoneSolutions const& present) {
    std::vector<std::string> names;
    for (Node const& solution : present.solutions) names.push_back(solution.name);
    if (names.empty()) {
      problem(zone, " has no flow solution (FlowSolution_t); name a file that has one");
      return nullptr;
    }
    if (chosen_.empty()) chosen_ = best(present);
    auto const found = std::find(names.begin(), names.end(), chosen_);
    if (found != names.end()) return &present.solutions[found - names.begin()];
    problem(zone, " has no solution '" + chosen_ + "'; those there are " + quote_list(names));
    return nullptr;
  }

  [[nodiscard]] std::string best(io::ZoneSolutions const& present) const {
    std::size_t most = 0;
    std::string out = present.solutions.front().name;
    for (Node const& solution : present.solutions) {
      bool const led_to = present.pointed.contains(solution.name);
      if (!present.pointed.empty() && !led_to) continue;
      auto const n =
          std::size_t(std::count_if(wanted_.variables.begin(), wanted_.variables.end(),
                                    [&](std::string const& name) { return solution.child(name) != nullptr; }));
      if (n < most + (led_to ? 0 : 1) || n == 0) continue;
      most = n;
      out = solution.name;
    }
    return out;
  }

  void read_arrays(Zone const& zone, cgns::ZoneLayout const& layout, Node const& solution) {
    Node const* located = solution.labelled("GridLocation_t");
    std::string const location = located == nullptr ? "Vertex" : file_.text(*located);
    std::string const where = ", solution '" + solution.name + "'";
    if (location != "Vertex" && location != "CellCenter")
      return problem(zone, where + ": is given at " + location + "; give it at Vertex or CellCenter");
    bool const at_nodes = location == "Vertex";
    if (at_nodes_ && *at_nodes_ != at_nodes)
      return problem(zone, where + ": is given at " + location + ", and in other zones it is not");
    at_nodes_ = at_nodes;
    out_.at_nodes = at_nodes;
    if (solution.labelled("IndexRange_t") != nullptr || solution.labelled("IndexArray_t") != nullptr)
      return problem(zone, where + ": is given for a part of the zone; give it for all of it");
    std::optional<StoredZone> const stored = stored_zone(zone, layout, solution, at_nodes);
    if (!stored) return problem(zone, where + ": has a Rind that does not fit its zone");
    std::set<std::string> names(out_.available.begin(), out_.available.end());
    for (Node const* array : solution.all("DataArray_t")) {
      if (names.insert(array->name).second) out_.available.push_back(array->name);
      if (std::find(wanted_.variables.begin(), wanted_.variables.end(), array->name) == wanted_.variables.end())
        continue;
      if (file_.count(*array) != stored->size()) {
        problem(zone, where + ": " + array->name + " has " + std::to_string(file_.count(*array)) +
                          " values, and the zone with its rind planes takes " + std::to_string(stored->size()));
        continue;
      }
      take(zone, layout, array->name, stored->inner(file_.reals(*array)), where);
    }
  }

  [[nodiscard]] std::optional<StoredZone> stored_zone(Zone const& zone, cgns::ZoneLayout const& layout,
                                                      Node const& solution, bool at_nodes) const {
    StoredZone out;
    if (layout.is_block()) {
      for (int a = 0; a < 3; ++a) out.core[a] = std::max(Index(1), Index(layout.extent[a]) - (at_nodes ? 0 : 1));
    } else {
      out.core[0] = at_nodes ? zone.size() : zone.n_elements;
    }
    Node const* rind = solution.labelled("Rind_t");
    if (rind == nullptr) return out;
    auto const planes = file_.integers(*rind);
    if (planes.size() != 2 * std::size_t(layout.index_dimension)) return std::nullopt;
    // Index directions of the file are those of the mesh with an extent of their own, in order.
    // More planes than anybody keeps beside a zone are damage; products of theirs would not be numbers any more.
    constexpr std::int64_t most_planes = 1000;  // as grids have them
    auto const fits = [](std::int64_t of_a_side) { return of_a_side >= 0 && of_a_side < most_planes; };
    std::size_t n = 0;
    for (int a = 0; a < 3 && n < planes.size(); ++a) {
      if (layout.is_block() && layout.index_dimension == 2 && a == layout.flat_axis) continue;
      if (!fits(planes[n]) || !fits(planes[n + 1])) return std::nullopt;
      out.low[a] = planes[n];
      out.high[a] = planes[n + 1];
      n += 2;
    }
    return out;
  }

  void take(Zone const& zone, cgns::ZoneLayout const& layout, std::string const& name, std::vector<double> values,
            std::string const& where) {
    auto const bad = std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad != values.end())
      return problem(zone, where + ": " + name + " has a value that is not finite, number " +
                               std::to_string(bad - values.begin() + 1) + " of the zone");
    ++zones_with_[name];
    auto& all = out_.values[name];
    Index const n_all = out_.at_nodes ? mesh_.n_nodes() : mesh_.is_structured() ? mesh_.n_cells() : mesh_.n_elements();
    all.resize(n_all);
    if (out_.at_nodes)
      put_nodes(zone, layout, values, all);
    else
      put_cells(zone, values, all);
  }

  void put_nodes(Zone const& zone, cgns::ZoneLayout const& layout, std::vector<double> const& values,
                 std::vector<double>& all) const {
    auto const dest = all.begin() + zone.first_node;
    auto const& place = mesh_.file_order.node;
    if (mesh_.is_structured() && layout.flat_axis >= 0) {
      auto const p = cgns::plane_steps(zone, layout.flat_axis);
      auto value = values.begin();
      for (int b = 0; b < zone.extent[p.axis[1]]; ++b)
        for (int a = 0; a < zone.extent[p.axis[0]]; ++a) {
          Index const n = a * p.step[0] + b * p.step[1];
          dest[n] = dest[n + p.across] = *value++;
        }
      return;
    }
    for (Index n = 0; n < zone.size(); ++n) {
      Index const from = place.empty() ? n : place[zone.first_node + n] - zone.first_node;
      dest[n] = values[from];
    }
  }

  /// Cells of a zone of elements stand in the order of their numbers.
  void put_cells(Zone const& zone, std::vector<double> const& values, std::vector<double>& all) const {
    if (mesh_.is_structured()) {
      Index first = 0;
      for (Zone const& before : mesh_.zones) {
        if (&before == &zone) break;
        first += Index(before.extent[0] - 1) * (before.extent[1] - 1) * (before.extent[2] - 1);
      }
      std::copy(values.begin(), values.end(), all.begin() + first);
      return;
    }
    std::vector<Index> order(zone.n_elements);
    std::iota(order.begin(), order.end(), zone.first_element);
    auto const& number = mesh_.elements.number;
    auto const& place = mesh_.file_order.element;
    if (!number.empty())
      std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return number[a] < number[b]; });
    else if (!place.empty())
      std::sort(order.begin(), order.end(), [&](Index a, Index b) { return place[a] < place[b]; });
    for (std::size_t n = 0; n < order.size(); ++n) all[order[n]] = values[n];
  }

  cgns::File file_;
  Mesh const& mesh_;
  SolutionWanted const& wanted_;
  std::string chosen_;
  cgns::Layout layout_;
  std::vector<io::ZoneSolutions> solutions_;
  std::optional<bool> at_nodes_;
  std::map<std::string, std::size_t> zones_with_;
  FlowSolution out_;
  Problems problems_;
};

}  // namespace

FlowSolution read_flow_solution(std::string const& path, Mesh const& mesh, SolutionWanted const& wanted) {
  if (mesh_format(path) != MeshFormat::cgns)
    throw IoError(path + ": is no CGNS file; flow solutions are read from CGNS files alone");
  return SolutionReader(path, mesh, wanted).read();
}

}  // namespace gridmorph
