#include <gridmorph/core/error.hpp>
#include <gridmorph/io/su2/su2_parser.hpp>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

namespace gridmorph::su2 {

namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == ','; }

std::string_view trim(std::string_view s) {
  while (!s.empty() && blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && blank(s.back())) s.remove_suffix(1);
  return s;
}

class Parser {
 public:
  Parser(std::string const& path, std::string_view text, std::vector<std::string>& notes,
         std::function<void(CoordinateText const&)> const& each_coordinate)
      : path_(path), text_(text), notes_(notes), each_coordinate_(each_coordinate) {}

  std::vector<ZoneText> run() {
    while (next_line()) {
      auto const equals = line_.find('=');
      if (equals == std::string_view::npos) {
        if (!skipping_)
          wrong("expected a keyword such as NELEM= or MARKER_TAG=, found '" + std::string(line_.substr(0, 40)) +
                "'; there may be more lines than the number above says");
        continue;
      }
      std::string const key(trim(line_.substr(0, equals)));
      keyword(key, trim(line_.substr(equals + 1)));
    }
    for (auto const& zone : zones_) {
      line_number_ = zone.line;
      if (!zone.has_elements || !zone.has_points)
        wrong(zone.name + " has no " + (zone.has_elements ? "NPOIN=" : "NELEM="));
    }
    if (zones_.empty()) wrong("holds no NDIME=; it is not an SU2 mesh");
    return std::move(zones_);
  }

 private:
  [[noreturn]] void wrong(std::string const& what) const {
    throw IoError(path_ + ":" + std::to_string(line_number_) + ": " + what);
  }

  /// The next line that says something, without its comment.
  bool next_line() {
    while (at_ < text_.size()) {
      std::size_t const end = std::min(text_.find('\n', at_), text_.size());
      line_ = text_.substr(at_, end - at_);
      at_ = end + 1;
      ++line_number_;
      line_ = line_.substr(0, line_.find('%'));
      if (!trim(line_).empty()) {
        rest_ = line_;
        return true;
      }
    }
    return false;
  }

  /// The next word of the line; empty at its end.
  std::string_view word() {
    while (!rest_.empty() && blank(rest_.front())) rest_.remove_prefix(1);
    std::size_t n = 0;
    while (n < rest_.size() && !blank(rest_[n])) ++n;
    auto const out = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return out;
  }

  template <class T>
  std::optional<T> number(std::string_view text) const {
    if (text.starts_with('+')) text.remove_prefix(1);
    T value{};
    auto const [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  template <class T>
  T expect(std::string_view text, std::string const& what) const {
    auto const value = number<T>(text);
    if (!value)
      wrong("expected " + what + ", found " +
            (text.empty() ? "the end of the line" : "'" + std::string(text.substr(0, 40)) + "'"));
    return *value;
  }

  /// The count behind a keyword; no file has more lines than bytes.
  Index count(std::string_view value, std::string const& key) {
    rest_ = value;
    auto const n = expect<std::int64_t>(word(), "a number after " + key + "=");
    if (n < 0 || n > std::int64_t(text_.size()))
      wrong(key + "= " + std::to_string(n) + " is more than the file can hold, or less than nothing");
    return n;
  }

  ZoneText& zone() {
    if (zones_.empty()) {
      zones_.emplace_back();
      zones_.back().name = "zone 1";
      zones_.back().line = line_number_;
    }
    return zones_.back();
  }

  void keyword(std::string const& key, std::string_view value) {
    skipping_ = false;
    if (key == "NZONE") return;
    if (key == "IZONE") {
      auto const n = count(value, key);
      // What comes before the first IZONE= (NDIME= among it) holds for all zones.
      bool const begun = !zones_.empty() && (zones_.back().numbered || zones_.back().has_elements ||
                                             zones_.back().has_points || !zones_.back().markers.empty());
      if (zones_.empty() || begun) zones_.emplace_back();
      zones_.back().numbered = true;
      if (zones_.back().dimension == 0) zones_.back().dimension = dimension_of_all_;
      zones_.back().name = "zone " + std::to_string(n);
      zones_.back().line = line_number_;
    } else if (key == "NDIME") {
      auto const n = count(value, key);
      if (n != 2 && n != 3) wrong("NDIME= " + std::to_string(n) + "; a mesh has 2 or 3 dimensions");
      auto& z = zone();
      if (z.has_elements || z.has_points) wrong("NDIME= comes after NELEM= or NPOIN=; put it first");
      z.dimension = int(n);
      if (!z.numbered) dimension_of_all_ = int(n);
    } else if (key == "NELEM") {
      elements(count(value, key));
    } else if (key == "NPOIN") {
      points(count(value, key));
    } else if (key == "NMARK") {
      count(value, key);
    } else if (key == "MARKER_TAG") {
      zone().markers.emplace_back();
      zone().markers.back().name = std::string(value);
      zone().markers.back().line = line_number_;
      if (value.empty()) wrong("MARKER_TAG= has no name");
    } else if (key == "MARKER_ELEMS") {
      if (zone().markers.empty()) wrong("MARKER_ELEMS= comes before any MARKER_TAG=");
      marker(zone().markers.back(), count(value, key));
    } else if (key == "SEND_TO" || key == "SEND_RECV") {
      if (zone().markers.empty()) wrong(key + "= comes before any MARKER_TAG=");
      rest_ = value;
      zone().markers.back().send_to = expect<int>(word(), "a number after " + key + "=");
    } else if (key == "NPERIODIC") {
      count(value, key);
    } else if (key == "PERIODIC_INDEX") {
      periodic(count(value, key));
    } else {
      skipping_ = true;
      if (std::find(skipped_.begin(), skipped_.end(), key) == skipped_.end()) {
        skipped_.push_back(key);
        notes_.push_back(path_ + ":" + std::to_string(line_number_) + ": " + key +
                         "= plays no part in morphing; left alone");
      }
    }
  }

  void expect_line(Index read, Index n, std::string const& what) {
    if (!next_line())
      wrong("the file ends after " + std::to_string(read) + " of " + std::to_string(n) + " " + what +
            "; get a whole copy of it");
  }

  void elements(Index n) {
    auto& z = zone();
    if (z.dimension == 0) wrong("NELEM= comes before NDIME=");
    if (z.has_elements) wrong("NELEM= for the second time; several meshes in one file need IZONE=");
    z.has_elements = true;
    for (Index e = 0; e < n; ++e) {
      expect_line(e, n, "elements");
      int const type = expect<int>(word(), "a VTK element type");
      int const nodes = vtk_nodes(type);
      bool const fits = z.dimension == 2 ? type == 5 || type == 9 : type == 10 || (type >= 12 && type <= 14);
      if (nodes == 0 || !fits)
        wrong("element type " + std::to_string(type) + " is no element of a " + std::to_string(z.dimension) +
              "-D mesh (2-D: 5, 9; 3-D: 10, 12, 13, 14)");
      z.vtk.push_back(type);
      for (int k = 0; k < nodes; ++k) z.nodes.push_back(expect<std::int64_t>(word(), "a node number"));
      z.start.push_back(Index(z.nodes.size()));
    }
  }

  void points(Index n) {
    auto& z = zone();
    if (z.dimension == 0) wrong("NPOIN= comes before NDIME=");
    if (z.has_points) wrong("NPOIN= for the second time; several meshes in one file need IZONE=");
    z.has_points = true;
    CoordinateText c;
    c.zone = zones_.size() - 1;
    for (Index p = 0; p < n; ++p) {
      expect_line(p, n, "points");
      c.point = p;
      for (c.component = 0; c.component != z.dimension; ++c.component) {
        auto const text = word();
        c.value = expect<double>(text, "a coordinate");
        z.coordinates.push_back(c.value);
        if (!each_coordinate_) continue;
        c.begin = std::size_t(text.data() - text_.data());
        c.end = c.begin + text.size();
        each_coordinate_(c);
      }
      auto const index = word();
      if (!index.empty() && expect<std::int64_t>(index, "the number of the point") != p) z.index_differs = true;
    }
  }

  void marker(Marker& m, Index n) {
    for (Index e = 0; e < n; ++e) {
      expect_line(e, n, "elements of marker '" + m.name + "'");
      if (auto const equals = line_.find('='); equals != std::string_view::npos) {
        std::string const key(trim(line_.substr(0, equals)));
        if ((key != "SEND_TO" && key != "SEND_RECV") || e > 0)
          wrong("expected an element of marker '" + m.name + "', found " + key + "=");
        keyword(key, trim(line_.substr(equals + 1)));
        --e;
        continue;
      }
      int const type = expect<int>(word(), "a VTK element type");
      int const nodes = type == 1 ? 1 : vtk_nodes(type);
      bool const fits = type == 1 || (zone().dimension == 2 ? type == 3 : type == 5 || type == 9);
      if (!fits)
        wrong("element type " + std::to_string(type) + " is no face of a " + std::to_string(zone().dimension) +
              "-D mesh");
      m.vtk.push_back(type);
      for (int k = 0; k < nodes; ++k) m.nodes.push_back(expect<std::int64_t>(word(), "a node number"));
      m.start.push_back(Index(m.nodes.size()));
      auto const transform = type == 1 ? word() : std::string_view{};
      m.transform.push_back(transform.empty() ? 0 : expect<int>(transform, "a PERIODIC_INDEX"));
    }
  }

  void periodic(Index index) {
    auto& list = zone().periodic;
    if (index != Index(list.size()))
      wrong("PERIODIC_INDEX= " + std::to_string(index) + ", expected " + std::to_string(list.size()));
    PeriodicEntry entry;
    for (double* values : {entry.center, entry.angle, entry.translation}) {
      expect_line(0, 3, "lines of a periodic transform");
      for (int c = 0; c < 3; ++c) {
        auto const text = word();
        if (text.empty() && c == 2 && zone().dimension == 2) continue;
        values[c] = expect<double>(text, "a number of a periodic transform");
      }
    }
    list.push_back(entry);
  }

  std::string const& path_;
  std::string_view text_;
  std::vector<std::string>& notes_;
  std::function<void(CoordinateText const&)> const& each_coordinate_;
  std::vector<ZoneText> zones_;
  std::vector<std::string> skipped_;
  std::string_view line_, rest_;
  std::size_t at_ = 0;
  Index line_number_ = 0;
  bool skipping_ = false;     ///< lines of a keyword that is not known
  int dimension_of_all_ = 0;  ///< NDIME before the first IZONE
};

}  // namespace

int vtk_nodes(int vtk_type) {
  switch (vtk_type) {
    case 3: return 2;
    case 5: return 3;
    case 9: return 4;
    case 10: return 4;
    case 12: return 8;
    case 13: return 6;
    case 14: return 5;
    default: return 0;
  }
}

std::vector<ZoneText> parse(std::string const& path, std::string_view text, std::vector<std::string>& notes,
                            std::function<void(CoordinateText const&)> const& each_coordinate) {
  return Parser(path, text, notes, each_coordinate).run();
}

}  // namespace gridmorph::su2
