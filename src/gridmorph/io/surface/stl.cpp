#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/surface/surface_io.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>

namespace gridmorph {

namespace {

constexpr std::size_t header_size = 84, facet_size = 50;
constexpr std::uint64_t most_facets = 500'000'000;  // three points each must have an int for a number

std::uint32_t little_endian(unsigned char const* at) {
  return std::uint32_t(at[0]) | std::uint32_t(at[1]) << 8 | std::uint32_t(at[2]) << 16 | std::uint32_t(at[3]) << 24;
}

void put(std::string& out, std::uint32_t v) {
  for (int byte = 0; byte < 4; ++byte) out += char(v >> (8 * byte) & 0xff);
}
void put(std::string& out, Vec3 const& v) {
  for (double const c : {v.x, v.y, v.z}) put(out, std::bit_cast<std::uint32_t>(float(c)));
}

TargetGeometry parse_binary(std::string const& bytes, std::uint32_t n, std::string const& path) {
  TargetGeometry out;
  out.points.reserve(3 * std::size_t(n));
  out.triangles.reserve(n);
  auto const* at = reinterpret_cast<unsigned char const*>(bytes.data()) + header_size;
  for (std::uint32_t f = 0; f < n; ++f, at += facet_size) {
    int const first = int(out.points.size());
    for (int corner = 0; corner < 3; ++corner) {
      std::array<double, 3> c{};
      for (int k = 0; k < 3; ++k) c[k] = double(std::bit_cast<float>(little_endian(at + 12 * (corner + 1) + 4 * k)));
      if (!std::isfinite(c[0]) || !std::isfinite(c[1]) || !std::isfinite(c[2]))
        throw IoError(path + ": facet " + std::to_string(f + 1) + " of " + std::to_string(n) +
                      " has a corner that is not finite; the file is damaged");
      out.points.push_back({c[0], c[1], c[2]});
    }
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

/// Words of a text, with the line each stands in.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  std::string_view next() {
    while (!text_.empty() && is_blank(text_.front())) skip();
    std::size_t end = 0;
    while (end < text_.size() && !is_blank(text_[end])) ++end;
    std::string_view const word = text_.substr(0, end);
    text_.remove_prefix(end);
    return word;
  }
  void skip_line() {
    while (!text_.empty() && text_.front() != '\n') text_.remove_prefix(1);
  }
  [[nodiscard]] int line() const { return line_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }
  void skip() {
    line_ += text_.front() == '\n' ? 1 : 0;
    text_.remove_prefix(1);
  }
  std::string_view text_;
  int line_ = 1;
};

bool same_word(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t n = 0; n < word.size(); ++n) {
    char const c = word[n] >= 'A' && word[n] <= 'Z' ? char(word[n] - 'A' + 'a') : word[n];
    if (c != lower[n]) return false;
  }
  return true;
}

class AsciiReader {
 public:
  AsciiReader(std::string_view text, std::string const& source) : words_(text), source_(source) {}

  TargetGeometry run() {
    for (auto word = words_.next(); !word.empty(); word = words_.next()) {
      if (same_word(word, "solid") || same_word(word, "endsolid"))
        words_.skip_line();  // names may hold anything
      else if (same_word(word, "facet"))
        facet();
      else
        fail("expected 'facet' or 'endsolid'", word);
    }
    if (out_.triangles.empty()) throw IoError(source_ + ": holds no facets; expected an STL surface");
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(std::string const& what, std::string_view found) const {
    throw IoError(source_ + ":" + std::to_string(words_.line()) + ": " + what + ", found " +
                  (found.empty() ? "the end of the file" : "'" + std::string(found.substr(0, 40)) + "'") +
                  "; the file is damaged or no STL file");
  }
  void expect(std::string_view wanted) {
    auto const word = words_.next();
    if (!same_word(word, wanted)) fail("expected '" + std::string(wanted) + "'", word);
  }
  double number(bool must_be_finite) {
    auto const word = words_.next();
    auto const value = to_number(word);
    if (!value || (must_be_finite && !std::isfinite(*value))) fail("expected a number", word);
    return *value;
  }
  void facet() {
    expect("normal");
    for (int c = 0; c < 3; ++c) number(false);  // what the points say counts
    expect("outer");
    expect("loop");
    if (out_.triangles.size() >= most_facets) throw IoError(source_ + ": has too many facets");
    int const first = int(out_.points.size());
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      Vec3 p;
      p.x = number(true);
      p.y = number(true);
      p.z = number(true);
      out_.points.push_back(p);
    }
    expect("endloop");
    expect("endfacet");
    out_.triangles.push_back({first, first + 1, first + 2});
  }

  Words words_;
  std::string const& source_;
  TargetGeometry out_;
};

}  // namespace

TargetGeometry parse_ascii_stl(std::string_view text, std::string const& source) {
  return AsciiReader(text, source).run();
}

TargetGeometry read_stl(std::string const& path) {
  std::string const bytes = io::read_file(path);
  if (bytes.empty()) throw IoError(path + ": is empty; expected an STL file");
  std::optional<std::uint64_t> declared;
  if (bytes.size() >= header_size) {
    declared = little_endian(reinterpret_cast<unsigned char const*>(bytes.data()) + 80);
    if (bytes.size() == header_size + facet_size * *declared) {
      if (*declared == 0) throw IoError(path + ": holds no facets; expected an STL surface");
      if (*declared > most_facets) throw IoError(path + ": has too many facets");
      return parse_binary(bytes, std::uint32_t(*declared), path);
    }
  }
  std::size_t const start = bytes.find_first_not_of(" \t\r\n");
  bool const text = start != std::string::npos && bytes.size() - start >= 5 &&
                    same_word(bytes.substr(start, 5), "solid") && bytes.find('\0') == std::string::npos;
  if (text) return parse_ascii_stl(bytes, path);
  if (!declared)
    throw IoError(path + ": is not an STL file: it has " + std::to_string(bytes.size()) +
                  " bytes, too few for a binary one, and does not begin with 'solid'");
  throw IoError(path + ": is not an STL file, or cut off: as a binary one with " + std::to_string(*declared) +
                " facets it would have " + std::to_string(header_size + facet_size * *declared) + " bytes, it has " +
                std::to_string(bytes.size()) + ", and it does not begin with 'solid'");
}

void write_stl(std::string const& path, SurfaceTriangles const& surface, StlFormat format) {
  std::string bytes;
  auto const line = [&bytes](char const* head, Vec3 const& v) {
    std::array<char, 120> text{};
    std::snprintf(text.data(), text.size(), "%s %.17g %.17g %.17g\n", head, v.x, v.y, v.z);
    bytes += text.data();
  };
  if (format == StlFormat::binary) {
    bytes = "surface written by gridmorph";
    bytes.resize(header_size - 4, ' ');
    put(bytes, std::uint32_t(surface.triangles.size()));
  } else {
    bytes = "solid gridmorph\n";
  }
  for (auto const& t : surface.triangles) {
    Vec3 const &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    Vec3 normal = cross(b - a, c - a);
    double const length = norm(normal);
    normal = length > 0 ? (1 / length) * normal : Vec3{0, 0, 0};
    if (format == StlFormat::binary) {
      for (Vec3 const& v : {normal, a, b, c}) put(bytes, v);
      bytes += std::string(2, '\0');
    } else {
      line("facet normal", normal);
      bytes += "outer loop\n";
      for (Vec3 const& v : {a, b, c}) line("vertex", v);
      bytes += "endloop\nendfacet\n";
    }
  }
  if (format == StlFormat::ascii) bytes += "endsolid gridmorph\n";
  io::OutputFile target(path);
  target.write(bytes);
  target.commit();
}

}  // namespace gridmorph
