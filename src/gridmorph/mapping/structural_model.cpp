#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_model.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/mapping/structural_model.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <unordered_map>

namespace gridmorph {

namespace {

using mapping::Lines;
using mapping::most_problems_per_file;

bool is_cgns(std::filesystem::path const& path) {
  std::error_code error;
  // Of what is no file, or empty, the reader of texts says why.
  return std::filesystem::is_regular_file(path, error) && !std::filesystem::is_empty(path, error) &&
         cgns::is_cgns(path.string());
}

/// Numbers of the nodes by their ids.
class NodeIds {
 public:
  explicit NodeIds(PointCloud const& nodes) : size_(nodes.size()) {
    if (nodes.id.empty()) return;
    Problems problems;
    for (std::size_t n = 0; n < nodes.size() && problems.messages().size() < most_problems_per_file; ++n)
      if (auto const [place, added] = numbers_.emplace(nodes.id[n], std::int32_t(n)); !added)
        problems.add(fmt::format("{}: the id {} is that of {} already; give every node its own", nodes.where(n),
                                 nodes.id[n], nodes.where(std::size_t(place->second))));
    problems.throw_if_any<ConfigError>();
  }
  [[nodiscard]] std::optional<std::int32_t> find(double id) const {
    if (!numbers_.empty()) {
      auto const found = numbers_.find(std::int64_t(id));
      return found == numbers_.end() ? std::nullopt : std::optional(found->second);
    }
    if (id < 1 || id > double(size_)) return std::nullopt;
    return std::int32_t(id) - 1;
  }

 private:
  std::size_t size_;
  std::unordered_map<std::int64_t, std::int32_t> numbers_;
};

/// Whole numbers of one line, without an empty last field; false (after noting the problem) when it is none.
bool read_whole_numbers(std::vector<std::string_view> const& fields, std::string const& where, Problems& problems,
                        std::vector<double>& numbers) {
  numbers.clear();
  for (std::string_view const field : fields) {
    if (field.empty() && numbers.size() == 4 && fields.size() == 5) break;
    auto const number = to_number(field);
    if (!number || *number != std::floor(*number) || std::fabs(*number) > 9e15) {
      problems.add(fmt::format("{}: \"{}\" is not a whole number; an element is id, n1, n2, n3 or id, n1, n2, n3, n4",
                               where, field.substr(0, 40)));
      return false;
    }
    numbers.push_back(*number);
  }
  if (numbers.size() == 4 || numbers.size() == 5) return true;
  problems.add(
      fmt::format("{}: expected id, n1, n2, n3 (triangle) or id, n1, n2, n3, n4 (quadrilateral), found {} "
                  "columns; is the file cut short?",
                  where, fields.size()));
  return false;
}

StructuralModel from_cgns(ModelFiles const& files) {
  ElementModel read = read_element_model(files.file.string(), files.solution.value_or(""));
  StructuralModel model;
  model.nodes.source = model.elements = files.file.string();
  model.nodes.counted_in = ", node ";
  model.nodes.position = std::move(read.position);
  model.nodes.displacement = std::move(read.displacement);
  model.nodes.imaginary = std::move(read.imaginary);
  model.nodes.line.resize(model.nodes.size());
  for (std::size_t n = 0; n < model.nodes.size(); ++n) model.nodes.line[n] = std::int64_t(n) + 1;
  for (std::size_t f = 0; f < read.facets.size(); ++f) model.facets.push_back({read.facets[f], std::int64_t(f) + 1});
  model.notes = std::move(read.notes);
  return model;
}

}  // namespace

std::vector<StructuralFacet> parse_elements(std::string_view text, std::string const& source, PointCloud const& nodes) {
  NodeIds const ids(nodes);
  std::vector<StructuralFacet> facets;
  std::unordered_map<double, std::int64_t> line_of_id;
  Problems problems;
  std::vector<std::string_view> fields;
  std::vector<double> numbers;
  char separator = 0;
  Lines lines(text);
  while (problems.messages().size() < most_problems_per_file && lines.next()) {
    bool const first = separator == 0;
    if (first) separator = mapping::separator_of(lines.line());
    mapping::split(lines.line(), separator, fields);
    std::string const where = fmt::format("{}:{}", source, lines.number());
    if (first && std::none_of(fields.begin(), fields.end(), [](auto f) { return to_number(f).has_value(); })) {
      static constexpr std::array<std::string_view, 4> nodes_of_header{"n1", "n2", "n3", "n4"};
      bool good = fields.size() == 4 || fields.size() == 5;
      for (std::size_t f = 1; f < fields.size() && good; ++f)
        good = mapping::plain_name(fields[f]) == nodes_of_header[f - 1];
      if (!good)
        throw ConfigError(fmt::format("{}: the header reads \"{}\"; write id,n1,n2,n3,n4 or leave it out", where,
                                      lines.line().substr(0, 80)));
      continue;
    }
    if (!read_whole_numbers(fields, where, problems, numbers)) continue;
    if (auto const [known, added] = line_of_id.emplace(numbers[0], lines.number()); !added)
      problems.add(fmt::format("{}: the element id {} is that of line {} already", where, numbers[0], known->second));
    StructuralFacet facet{{-1, -1, -1, -1}, lines.number()};
    if (numbers.size() == 5 && numbers[4] == numbers[3]) numbers.pop_back();
    bool good = true;
    for (std::size_t c = 0; c + 1 < numbers.size(); ++c) {
      auto const node = ids.find(numbers[c + 1]);
      if (!node)
        problems.add(
            fmt::format("{}: element {} names node {}, which is not in {}; complete the nodes or correct the "
                        "element",
                        where, numbers[0], numbers[c + 1], nodes.source));
      facet.node[c] = node.value_or(-1);
      good = good && node && std::find(facet.node.begin(), facet.node.begin() + c, *node) == facet.node.begin() + c;
      if (node && !good)
        problems.add(fmt::format("{}: element {} names node {} twice", where, numbers[0], numbers[c + 1]));
      if (!good) break;
    }
    if (good) facets.push_back(facet);
  }
  if (problems.messages().size() >= most_problems_per_file) problems.add(source + ": further problems are not listed");
  problems.throw_if_any<ConfigError>();
  if (facets.empty()) throw ConfigError(source + ": holds no elements; expected lines of id, n1, n2, n3[, n4]");
  return facets;
}

StructuralModel read_structural_model(ModelFiles const& files) {
  if (is_cgns(files.file)) {
    if (files.elements)
      throw ConfigError(fmt::format("'{}' is a CGNS file and has elements of its own; remove elements = \"{}\"",
                                    files.file.string(), files.elements->string()));
    return from_cgns(files);
  }
  StructuralModel model;
  model.nodes = read_point_cloud(files.file);
  if (files.solution)
    throw ConfigError(fmt::format("'{}' is no CGNS file and has no solution '{}'; remove the key 'solution'",
                                  files.file.string(), *files.solution));
  if (files.elements) {
    model.elements = files.elements->string();
    model.facets =
        parse_elements(mapping::read_text_file(*files.elements, "element file"), model.elements, model.nodes);
  }
  return model;
}

}  // namespace gridmorph
