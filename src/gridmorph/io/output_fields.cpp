#include <gridmorph/core/error.hpp>
#include <gridmorph/io/output_fields.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace gridmorph::io {

void check_fields(Index n_nodes, Index n_cells, Coordinates const& baseline, Coordinates const& morphed,
                  OutputFields const& fields) {
  auto const expect = [](std::string const& what, Index found, Index expected) {
    if (found != expected)
      throw MeshError(what + " has " + std::to_string(found) + " values, but the mesh asks for " +
                      std::to_string(expected));
  };
  expect("the array of morphed coordinates", morphed.size(), n_nodes);
  if (fields.displacement) expect("the array of baseline coordinates", baseline.size(), n_nodes);
  for (auto const& f : fields.nodes) expect("node field '" + f.name + "'", Index(f.values.size()), n_nodes);
  for (auto const& f : fields.cells) expect("cell field '" + f.name + "'", Index(f.values.size()), n_cells);
}

std::uint64_t bytes_of_fields(OutputFields const& fields, std::size_t n_zones, Index n_nodes, Index n_cells) {
  if (fields.empty()) return 0;
  std::uint64_t const node_fields = fields.nodes.size() + (fields.displacement ? 3 : 0);
  std::uint64_t const nodes_per_field = 4;  // array, data class, units, exponents
  return cgns::File::bytes_per_node * (nodes_per_field * (node_fields + fields.cells.size()) + 4) * n_zones +
         sizeof(double) * (node_fields * std::uint64_t(n_nodes) + fields.cells.size() * std::uint64_t(n_cells));
}

namespace {

using cgns::Node;

/// The solutions that viewers are led to, step by step; empty where the file leads to none.
std::set<std::string> pointed_solutions(cgns::File const& file, Node const& zone) {
  std::set<std::string> out;
  for (Node const* listed : zone.all("ZoneIterativeData_t")) {
    Node iterative = *listed;
    file.load_children(iterative);
    Node const* pointers = iterative.child("FlowSolutionPointers");
    if (pointers == nullptr || file.type(*pointers) != "C1") continue;
    constexpr std::size_t name_length = 32;
    std::string const names = file.characters(*pointers);
    for (std::size_t at = 0; at < names.size(); at += name_length) {
      std::string name = names.substr(at, name_length);
      name = name.substr(0, name.find('\0'));
      name.erase(name.find_last_not_of(' ') + 1);
      out.insert(name);
    }
  }
  return out;
}

std::vector<std::int64_t> rind_of(cgns::File const& file, Node const& solution) {
  Node const* rind = solution.labelled("Rind_t");
  return rind == nullptr ? std::vector<std::int64_t>() : file.integers(*rind);
}

/// The nearest node of a label at a coordinate's array or above it.
Node const* inherited(std::array<Node const*, 4> const& levels, char const* label) {
  for (Node const* level : levels)
    if (Node const* found = level->labelled(label)) return found;
  return nullptr;
}

}  // namespace

std::vector<ZoneSolutions> zone_solutions(cgns::File const& file, cgns::Layout const& layout) {
  std::vector<ZoneSolutions> out;
  for (auto const& zone : layout.zones) {
    ZoneSolutions& own = out.emplace_back();
    own.pointed = pointed_solutions(file, *zone.node);
    for (Node const* listed : zone.node->all("FlowSolution_t")) {
      own.solutions.push_back(*listed);
      file.load_children(own.solutions.back());
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (zone.array[c] == nullptr) continue;
      own.coordinate[c] = *zone.array[c];
      file.load_children(own.coordinate[c]);
    }
  }
  return out;
}

/// Whether a solution is of the whole zone, at this location, with room for what is to be added.
bool SolutionWriter::fits(Node const& solution, std::string const& location) const {
  if (solution.linked) return false;
  Node const* at = solution.labelled("GridLocation_t");
  if ((at == nullptr ? "Vertex" : file_.text(*at)) != location) return false;
  if (solution.labelled("IndexRange_t") != nullptr || solution.labelled("IndexArray_t") != nullptr) return false;
  auto const rind = rind_of(file_, solution);
  if (!rind.empty() && rind.size() != 2 * dimensions_.size()) return false;
  constexpr std::int64_t most_planes = 1000;  // as grids have them
  if (std::any_of(rind.begin(), rind.end(), [](std::int64_t planes) { return planes < 0 || planes >= most_planes; }))
    return false;
  Node const* array = solution.labelled("DataArray_t");
  if (array == nullptr) return rind.empty();  // how much room it has is not known by its planes alone
  auto const stored = file_.dimensions(*array);
  if (stored.size() != dimensions_.size()) return false;
  for (std::size_t a = 0; a < stored.size(); ++a)
    if (stored[a] != dimensions_[a] + (rind.empty() ? 0 : rind[2 * a] + rind[2 * a + 1])) return false;
  return true;
}

std::vector<Node const*> SolutionWriter::usable(std::string const& location) const {
  std::vector<Node const*> out;
  auto const& pointed = present_.pointed;
  for (Node const& solution : present_.solutions) {
    if (!fits(solution, location) || (!pointed.empty() && !pointed.contains(solution.name))) continue;
    out.push_back(&solution);
    if (pointed.empty()) break;
  }
  return out;
}

SolutionWriter::SolutionWriter(cgns::File& file, cgns::ZoneLayout const& zone, ZoneSolutions const& present,
                               std::string const& own_name, std::string const& location, std::vector<Index> dimensions,
                               std::vector<std::string> const& names)
    : file_(file), zone_(zone), present_(present), dimensions_(std::move(dimensions)) {
  auto const solutions = usable(location);
  auto const taken = [&] {
    return std::any_of(solutions.begin(), solutions.end(), [&](Node const* solution) {
      return std::any_of(names.begin(), names.end(),
                         [&](std::string const& name) { return solution->child(prefix_ + name) != nullptr; });
    });
  };
  for (int n = 1; taken(); ++n) prefix_ = n == 1 ? "Morph" : "Morph" + std::to_string(n);
  for (Node const* solution : solutions) places_.push_back({file.id(*solution), rind_of(file, *solution)});
  if (!places_.empty()) return;
  std::string name = own_name;
  for (int n = 2; zone.node->child(name); ++n) name = own_name + std::to_string(n);
  places_.push_back({file.create(file.id(*zone.node), name, "FlowSolution_t"), {}});
  file.create_text(places_.back().id, "GridLocation", "GridLocation_t", location);
}

/// Rind planes, which no morph knows values for, repeat the values beside them.
std::vector<double> SolutionWriter::with_rind(Place const& place, double const* values,
                                              std::vector<Index>& dimensions) const {
  std::array<Index, 3> core{1, 1, 1}, low{0, 0, 0}, all{1, 1, 1};
  for (std::size_t a = 0; a < dimensions_.size(); ++a) {
    core[a] = dimensions_[a];
    low[a] = Index(place.rind[2 * a]);
    all[a] = dimensions[a] = core[a] + low[a] + Index(place.rind[2 * a + 1]);
  }
  std::vector<double> out(all[0] * all[1] * all[2]);
  std::array<Index, 3> at{};
  std::size_t n = 0;
  auto const inside = [&](std::size_t a) { return std::clamp<Index>(at[a] - low[a], 0, core[a] - 1); };
  for (at[2] = 0; at[2] < all[2]; ++at[2])
    for (at[1] = 0; at[1] < all[1]; ++at[1])
      for (at[0] = 0; at[0] < all[0]; ++at[0])
        out[n++] = values[inside(0) + core[0] * (inside(1) + core[1] * inside(2))];
  return out;
}

template <class Describe>
void SolutionWriter::add_array(std::string const& name, double const* values, Describe const& describe) const {
  for (Place const& place : places_) {
    std::vector<Index> dimensions = dimensions_;
    std::vector<double> padded;
    if (!place.rind.empty()) padded = with_rind(place, values, dimensions);
    describe(file_.create(place.id, prefix_ + name, "DataArray_t", "R8", dimensions,
                          place.rind.empty() ? values : padded.data()));
  }
}

namespace {

/// Exponents of mass, length, time, temperature and angle.
void add_exponents(cgns::File& file, double array, std::array<double, 5> const& exponents) {
  file.create(array, "DimensionalExponents", "DimensionalExponents_t", "R8", {5}, exponents.data());
}

}  // namespace

void SolutionWriter::add(std::string const& name, double const* values, FieldUnit unit) const {
  add_array(name, values, [&](double array) {
    if (unit == FieldUnit::number) {
      file_.create_text(array, "DataClass", "DataClass_t", "NondimensionalParameter");
      return;
    }
    file_.create_text(array, "DataClass", "DataClass_t", "Dimensional");
    std::string units;
    for (char const* of : {"Null", "Null", "Null", "Null", "Degree"}) {
      units += of;
      units.resize((units.size() + 31) / 32 * 32, ' ');
    }
    file_.create(array, "DimensionalUnits", "DimensionalUnits_t", "C1", {32, 5}, units.data());
    add_exponents(file_, array, {0, 0, 0, 0, 1});
  });
}

void SolutionWriter::add_displacement(std::string const& name, double const* values, int component) const {
  Node const& coordinate = present_.coordinate[component];
  std::array<Node const*, 4> const levels{&coordinate, zone_.grid, zone_.node, zone_.base};
  Node const* data_class = inherited(levels, "DataClass_t");
  std::string const text = data_class == nullptr ? "" : file_.text(*data_class);
  Node const* units = inherited(levels, "DimensionalUnits_t");
  Node const* conversion = coordinate.labelled("DataConversion_t");
  add_array(name, values, [&](double array) {
    if (text.empty()) return;
    file_.create_text(array, "DataClass", "DataClass_t", text);
    if (text == "NormalizedByDimensional" && conversion != nullptr) {
      auto factors = file_.reals(*conversion);
      if (factors.size() == 2) {
        factors[1] = 0;  // offsets cancel in a difference
        file_.create(array, "DataConversion", "DataConversion_t", "R8", {2}, factors.data());
      }
    }
    if (text != "Dimensional") return;
    if (units != nullptr && file_.type(*units) == "C1")
      file_.create(array, "DimensionalUnits", "DimensionalUnits_t", "C1", file_.dimensions(*units),
                   file_.characters(*units).data());
    add_exponents(file_, array, {0, 1, 0, 0, 0});
  });
}

std::vector<std::string> names_of_nodes(OutputFields const& fields, std::array<bool, 3> const& has) {
  std::vector<std::string> names;
  for (std::size_t c = 0; c < 3 && fields.displacement; ++c)
    if (has[c]) names.emplace_back(displacement_names[c]);
  for (auto const& field : fields.nodes) names.push_back(field.name);
  return names;
}

std::vector<std::string> names_of_cells(OutputFields const& fields) {
  std::vector<std::string> names;
  for (auto const& field : fields.cells) names.push_back(field.name);
  return names;
}

}  // namespace gridmorph::io
