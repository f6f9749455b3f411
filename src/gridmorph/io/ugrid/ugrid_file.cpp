#include <gridmorph/core/error.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/kind_by_name.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/printable.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/real_text.hpp>
#include <gridmorph/io/replaced_text.hpp>
#include <gridmorph/io/ugrid/ugrid_file.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::ugrid {

namespace {

/// How the numbers of a file are stored.
struct Storage {
  std::string_view word;  ///< before the ending of a file's name: "b8", "lr4", ...; empty for text
  bool text = false, big = false, records = false;
  int real_bytes = 8, integer_bytes = 4;
};

/// The numbers of a file one after another.
class Bytes {
 public:
  /// Reads the whole file. Throws IoError.
  explicit Bytes(std::string const& path);

  [[nodiscard]] std::string const& text() const { return text_; }
  [[nodiscard]] Storage const& storage() const { return storage_; }
  [[nodiscard]] bool swapped() const;
  [[nodiscard]] std::size_t at() const { return at_; }

  std::int64_t integer(char const* what);
  double real(char const* what);
  /// Throws unless the rest of the file can hold so many numbers of each kind.
  void expect(std::uint64_t integers, std::uint64_t reals) const;
  /// The length before or behind a record, where there are records.
  void mark(std::uint64_t length);
  [[noreturn]] void fail(std::string const& what) const { fail_at(at_, what); }
  [[noreturn]] void fail_at(std::size_t at, std::string const& what) const;

 private:
  template <class T>
  T raw(char const* what);
  std::string_view word(char const* what);

  std::string path_, text_;
  Storage storage_;
  std::size_t at_ = 0;
};

constexpr std::array<Storage, 10> storages{{{"b8", false, true, false, 8, 4},
                                            {"b4", false, true, false, 4, 4},
                                            {"lb8", false, false, false, 8, 4},
                                            {"lb4", false, false, false, 4, 4},
                                            {"r8", false, true, true, 8, 4},
                                            {"r4", false, true, true, 4, 4},
                                            {"lr8", false, false, true, 8, 4},
                                            {"lr4", false, false, true, 4, 4},
                                            {"b8l", false, true, false, 8, 8},
                                            {"lb8l", false, false, false, 8, 8}}};

/// How a file is stored by its name; text where that says nothing else.
Storage storage_of(std::string_view path) {
  auto const stem = path.substr(0, path.rfind('.'));
  auto const dot = stem.find_last_of("./");
  auto const word = dot == std::string_view::npos || stem[dot] == '/' ? std::string_view() : stem.substr(dot + 1);
  auto const found = std::find_if(storages.begin(), storages.end(), [&](Storage const& s) { return s.word == word; });
  return found == storages.end() ? Storage{{}, true, false, false, 8, 4} : *found;
}

Bytes::Bytes(std::string const& path) : path_(path), text_(io::read_file(path)), storage_(storage_of(path)) {}

bool Bytes::swapped() const { return storage_.big != (std::endian::native == std::endian::big); }

void Bytes::fail_at(std::size_t at, std::string const& what) const {
  at = std::min(at, text_.size());
  std::string const place =
      storage_.text ? ":" + std::to_string(1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n'))
                    : ", byte " + std::to_string(at);
  throw IoError(path_ + place + ": " + what);
}

template <class T>
T Bytes::raw(char const* what) {
  if (text_.size() - at_ < sizeof(T))
    fail("the file ends where " + std::string(what) + " has to follow; get a whole copy of it");
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
  if (swapped()) std::reverse(bytes.begin(), bytes.end());
  at_ += sizeof(T);
  return std::bit_cast<T>(bytes);
}

std::string_view Bytes::word(char const* what) {
  while (at_ < text_.size() && io::is_blank(text_[at_])) ++at_;
  std::size_t const begin = at_;
  while (at_ < text_.size() && !io::is_blank(text_[at_])) ++at_;
  if (begin == at_) fail("the file ends where " + std::string(what) + " has to follow; get a whole copy of it");
  return std::string_view(text_).substr(begin, at_ - begin);
}

std::int64_t Bytes::integer(char const* what) {
  if (!storage_.text) return storage_.integer_bytes == 8 ? raw<std::int64_t>(what) : raw<std::int32_t>(what);
  auto const found = word(what);
  std::int64_t value = 0;
  auto const [end, failure] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (failure != std::errc() || end != found.data() + found.size())
    fail_at(at_ - found.size(), "expected " + std::string(what) + ", found '" + io::printable(found) +
                                    "'; binary files say so in their name (mesh.b8.ugrid, mesh.lb8.ugrid, ...)");
  return value;
}

double Bytes::real(char const* what) {
  if (!storage_.text) return storage_.real_bytes == 8 ? raw<double>(what) : double(raw<float>(what));
  auto const found = word(what);
  auto const value = io::real_of(found);
  if (!value) fail_at(at_ - found.size(), "expected " + std::string(what) + ", found '" + io::printable(found) + "'");
  return *value;
}

void Bytes::expect(std::uint64_t integers, std::uint64_t reals) const {
  std::uint64_t const per_integer = storage_.text ? 2 : std::uint64_t(storage_.integer_bytes),
                      per_real = storage_.text ? 2 : std::uint64_t(storage_.real_bytes);
  std::uint64_t const left = text_.size() - at_ + (storage_.text ? 1 : 0);
  if (integers > left / per_integer || reals > left / per_real || integers * per_integer + reals * per_real > left)
    fail("the counts at the beginning ask for " + std::to_string(integers) + " whole numbers and " +
         std::to_string(reals) +
         " coordinates, more than the rest of the file holds; get a whole copy of it, or name it as it is stored (b8, "
         "lb8, r8, lr8, b4, ... before .ugrid)");
}

void Bytes::mark(std::uint64_t length) {
  if (!storage_.records) return;
  // Markers have 4 bytes, which records of 4 GB and more go beyond.
  auto const found = raw<std::uint32_t>("the length of a record");
  if (found != std::uint32_t(length))
    fail("a record of " + std::to_string(length) + " bytes is marked with " + std::to_string(found) +
         "; the file is damaged, or stored in another way than its name says");
}

namespace fs = std::filesystem;

constexpr std::array<ElementType, 4> volumes{ElementType::tetrahedron, ElementType::pyramid, ElementType::prism,
                                             ElementType::hexahedron};
/// UGRID lists the apex of a pyramid third, its base being 1, 4, 5, 2.
constexpr std::array<std::size_t, 5> pyramid_order{0, 3, 4, 1, 2};

/// Nodes, triangles, quadrilaterals, and the four kinds of volumes.
using Counts = std::array<Index, 7>;

Counts read_counts(Bytes& in) {
  constexpr std::array<char const*, 7> names{"nodes",    "triangles", "quadrilaterals", "tetrahedra",
                                             "pyramids", "prisms",    "hexahedra"};
  constexpr std::array<std::uint64_t, 7> numbers{0, 4, 5, 4, 5, 6, 8};
  auto const integer_bytes = std::uint64_t(in.storage().integer_bytes);
  in.mark(7 * integer_bytes);
  Counts out{};
  std::uint64_t integers = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = in.integer("a count");
    if (out[k] < 0 || out[k] > std::numeric_limits<Index32>::max())
      in.fail("there are " + std::to_string(out[k]) + " " + names[k] +
              ": the file is damaged, or stored in another way than its name says (b8, lb8, r8, lr8, b4, ... before "
              ".ugrid; text without)");
    integers += numbers[k] * std::uint64_t(out[k]);
  }
  in.mark(7 * integer_bytes);
  in.expect(integers, 3 * std::uint64_t(out[0]));
  if (in.storage().records)
    in.mark(integers * integer_bytes + 3 * std::uint64_t(out[0]) * std::uint64_t(in.storage().real_bytes));
  return out;
}

/// What a surface is called and is, by its line in a .mapbc file: number, boundary condition of FUN3D, name.
struct SurfaceFacts {
  std::string name;
  int condition = 0;
};

PatchKind kind_of_condition(int c, std::string const& name) {
  if (c == 3 || c == 4 || c == 5) return c == 3 ? PatchKind::farfield : PatchKind::wall;
  if (c >= 3000 && c < 5000) return PatchKind::wall;
  if (c == 5026 || c == 5051 || c == 5052 || c == 7012 || c == 7031 || c == 7105) return PatchKind::outflow;
  if (c >= 5000 && c < 6000) return PatchKind::farfield;
  if ((c >= 6000 && c < 6100) || (c >= 6600 && c < 6700)) return PatchKind::symmetry;
  if (c == 7011 || c == 7036 || (c >= 7100 && c < 7105)) return PatchKind::inflow;
  if (c == -1) return PatchKind::connection;
  return io::kind_by_name(name);
}

class Reader {
 public:
  explicit Reader(std::string const& path) : path_(path), in_(path) {
    mesh_.source = path;
    mesh_.first_number = 1;
    mesh_.dimension = 3;
  }

  Mesh run() {
    Counts const n = read_counts(in_);
    if (n[0] == 0 || n[3] + n[4] + n[5] + n[6] == 0)
      throw MeshError(path_ + ": has no nodes or no volumes; surface meshes have nothing to morph");
    mesh_.add_zone("zone 1", n[0]);
    mesh_.zones.back().single_precision = in_.storage().real_bytes == 4;
    mesh_.coordinates = Coordinates(n[0]);
    for (Index k = 0; k < n[0]; ++k) {
      double const x = in_.real("a coordinate"), y = in_.real("a coordinate"), z = in_.real("a coordinate");
      mesh_.coordinates.set(k, {x, y, z});
    }
    Problems problems;
    io::check_places(mesh_, path_, problems);
    problems.throw_if_any<MeshError>();
    surfaces(n);
    for (std::size_t k = 0; k < volumes.size(); ++k) elements(volumes[k], n[3 + k]);
    if (io::orient_prisms(mesh_))
      mesh_.notes.push_back(path_ + ": the prisms are numbered with bottom triangles outwards; taken so");
    orient_pyramids();
    check_mesh(mesh_);
    return std::move(mesh_);
  }

 private:
  Index32 node(char const* of, Index number) {
    std::size_t const begin = in_.at();
    std::int64_t const n = in_.integer("a node number");
    if (n < 1 || n > mesh_.n_nodes())
      in_.fail_at(begin, std::string(of) + " " + std::to_string(number + 1) + " has node " + std::to_string(n) +
                             ", and there are " + std::to_string(mesh_.n_nodes()) + ", counted from 1");
    return Index32(n - 1);
  }

  void surfaces(Counts const& n) {
    CsrGraph faces;
    std::array<Index32, 4> row{};
    for (std::size_t corners = 3; corners <= 4; ++corners)
      for (Index f = 0; f < n[corners - 2]; ++f) {
        for (std::size_t c = 0; c < corners; ++c) row[c] = node(corners == 3 ? "triangle" : "quadrilateral", f);
        faces.add(std::span<Index32 const>(row.data(), corners));
      }
    auto const facts = read_mapbc();
    std::map<std::int64_t, std::size_t> known;
    for (Index f = 0; f < faces.size(); ++f) {
      std::int64_t const number = in_.integer("the number of a surface");
      auto const [at, is_new] = known.try_emplace(number, mesh_.patches.size());
      if (is_new) add_patch(number, facts);
      mesh_.patches[at->second].faces.add(faces[f]);
    }
  }

  void add_patch(std::int64_t number, std::map<std::int64_t, SurfaceFacts> const& facts) {
    Patch patch;
    patch.zone = 0;
    patch.name = "surface " + std::to_string(number);
    if (auto const found = facts.find(number); found != facts.end()) {
      patch.bc_type = std::to_string(found->second.condition);
      patch.kind = kind_of_condition(found->second.condition, found->second.name);
      if (!found->second.name.empty()) patch.name = found->second.name;
    }
    mesh_.patches.push_back(std::move(patch));
  }

  /// Numbers of surfaces that the file beside the mesh names.
  std::map<std::int64_t, SurfaceFacts> read_mapbc() {
    fs::path const beside = mapbc_of(path_);
    std::map<std::int64_t, SurfaceFacts> out;
    std::error_code ignored;
    if (!fs::is_regular_file(beside, ignored)) return out;
    std::istringstream lines(io::read_file(beside.string()));
    std::string line;
    std::getline(lines, line);  // how many
    for (int row = 2; std::getline(lines, line); ++row) {
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      std::istringstream words(line);
      std::int64_t number = 0;
      SurfaceFacts facts;
      if (!(words >> number >> facts.condition))
        throw IoError(beside.string() + ":" + std::to_string(row) +
                      ": expected the number of a surface, its boundary condition and its name, found '" +
                      io::printable(line) + "'");
      words >> facts.name;
      out[number] = facts;
    }
    mesh_.notes.push_back(path_ + ": names and kinds of its surfaces are those of " + beside.filename().string());
    return out;
  }

  void elements(ElementType type, Index n) {
    std::vector<Index32> row(n_corners(type)), listed(row.size());
    std::string const name(to_string(type));
    for (Index e = 0; e < n; ++e) {
      for (Index32& v : listed) v = node(name.c_str(), e);
      for (std::size_t k = 0; k < row.size(); ++k) row[k] = listed[type == ElementType::pyramid ? pyramid_order[k] : k];
      mesh_.add_element(type, row);
    }
  }

  /// Writers differ in which way round the base is listed.
  void orient_pyramids() {
    auto const& elements = mesh_.elements;
    auto& item = mesh_.elements.nodes.item;
    Index balance = 0;
    auto const each = [&](auto const& visit) {
      for (Index e = 0; e < elements.size(); ++e)
        if (elements.type[e] == ElementType::pyramid) visit(e);
    };
    each([&](Index e) {
      auto const n = elements.nodes[e];
      auto const x = [&](std::size_t k) { return mesh_.coordinates[n[k]]; };
      balance += dot(cross(x(2) - x(0), x(3) - x(1)), x(4) - x(0)) > 0 ? 1 : -1;
    });
    if (balance >= 0) return;
    each([&](Index e) { std::swap(item[elements.nodes.first[e] + 1], item[elements.nodes.first[e] + 3]); });
    mesh_.notes.push_back(path_ + ": the bases of pyramids are numbered the other way round; taken so");
  }

  std::string const& path_;
  Bytes in_;
  Mesh mesh_;
};

}  // namespace

bool is_ugrid(std::string const& path) { return path.ends_with(".ugrid"); }

std::string mapbc_of(std::string const& path) {
  fs::path beside(path);
  beside.replace_extension();
  if (!storage_of(path).text) beside.replace_extension();
  return (beside += ".mapbc").string();
}

Mesh read(std::string const& path) { return Reader(path).run(); }

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed) {
  Bytes in(input);
  Counts const n = read_counts(in);
  if (n[0] != mesh.n_nodes() || n[3] + n[4] + n[5] + n[6] != mesh.n_elements())
    throw IoError(input + ": holds another mesh than the one that was read; give the file of that one");
  if (auto const wanted = storage_of(output).word; is_ugrid(output) && wanted != in.storage().word)
    throw IoError(output + ": is named as if it were stored as " + (wanted.empty() ? "text" : std::string(wanted)) +
                  ", and it is written as " + (in.storage().word.empty() ? "text" : std::string(in.storage().word)) +
                  ", as " + input + " is; give it such a name");
  io::ReplacedText out(in.text());
  for (Index k = 0; k < n[0]; ++k) {
    Vec3 const to = morphed[k];
    for (double const value : {to.x, to.y, to.z}) {
      std::size_t const begin = in.at();
      double const before = in.real("a coordinate");
      if (in.storage().text)
        out.replace_word(begin, before, value);
      else if (in.storage().real_bytes == 8)
        out.replace_raw(begin, value, in.swapped());
      else
        out.replace_raw(begin, float(value), in.swapped());
    }
  }
  io::OutputFile target(output);
  target.write(out.take());
  target.commit();
}

}  // namespace gridmorph::ugrid
