#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/plot3d/plot3d_layout.hpp>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace gridmorph::plot3d {

Bytes::Bytes(std::string const& path) {
  io::FilesRead::note(path);
  errno = 0;
  file_.open(path, std::ios::binary | std::ios::ate);
  if (!file_) throw IoError(path + ": cannot be opened for reading: " + std::strerror(errno));
  auto const end = file_.tellg();
  if (end < 0) throw IoError(path + ": cannot be examined");
  size_ = std::uint64_t(end);
}

bool Bytes::read(std::uint64_t at, void* to, std::uint64_t count) {
  if (count > size_ || at > size_ - count) return false;
  file_.clear();
  file_.seekg(std::streamoff(at));
  return bool(file_.read(static_cast<char*>(to), std::streamsize(count)));
}

namespace {

constexpr std::int64_t most_zones = 1'000'000;
constexpr std::uint64_t most_records = std::uint64_t(most_zones) + 2;

std::int64_t to_integer(unsigned char const* bytes, int width, bool big_endian) {
  std::uint64_t value = 0;
  for (int b = 0; b < width; ++b) value = (value << 8) | bytes[big_endian ? b : width - 1 - b];
  return width == 4 ? std::int64_t(std::int32_t(std::uint32_t(value))) : std::int64_t(value);
}

/// The integers in a range of the file; nothing when the range is not in it.
std::optional<std::vector<std::int64_t>> integers(Bytes& file, std::uint64_t at, std::uint64_t count, bool big_endian) {
  if (count > file.size() / 4) return std::nullopt;
  std::vector<unsigned char> bytes(count * 4);
  if (!file.read(at, bytes.data(), bytes.size())) return std::nullopt;
  std::vector<std::int64_t> out;
  for (std::uint64_t n = 0; n < count; ++n) out.push_back(to_integer(bytes.data() + 4 * n, 4, big_endian));
  return out;
}

/// Extents of the zones; nothing when a number of nodes is not positive, a zone is a line, or all of them need more
/// than `room` bytes.
std::optional<std::vector<ZoneData>> zones_of(std::vector<std::int64_t> const& sizes, int dimensions,
                                              std::uint64_t room) {
  std::vector<ZoneData> out;
  std::uint64_t nodes = 0;
  for (std::size_t z = 0; z < sizes.size() / std::size_t(dimensions); ++z) {
    ZoneData zone;
    std::uint64_t product = 1;
    int thick = 0;
    for (int a = 0; a < dimensions; ++a) {
      std::int64_t const n = sizes[z * std::size_t(dimensions) + std::size_t(a)];
      if (n < 1 || std::uint64_t(n) > room) return std::nullopt;
      zone.extent[a] = int(n);
      if (product > room / std::uint64_t(n)) return std::nullopt;
      product *= std::uint64_t(n);
      thick += n > 1 ? 1 : 0;
    }
    if (thick < 2) return std::nullopt;  // a line or a point
    nodes += product;
    if (nodes > room) return std::nullopt;
    out.push_back(std::move(zone));
  }
  return out;
}

/// A layout that fits, or how near one came to it.
struct Candidate {
  FileLayout layout;
  bool fits = false;
  int agreement = 0;       ///< how much of the file agrees before it does not
  std::uint64_t miss = 0;  ///< bytes too many or too few
  std::string why;         ///< not
};

std::string extents_text(std::vector<ZoneData> const& zones) {
  std::string text = std::to_string(zones.size()) + (zones.size() == 1 ? " zone of " : " zones, the first of ");
  auto const& e = zones.front().extent;
  return text + std::to_string(e[0]) + " x " + std::to_string(e[1]) + " x " + std::to_string(e[2]) + " nodes";
}

/// The integers of a record, split or not.
std::optional<std::vector<std::int64_t>> integers(Bytes& file, std::vector<Segment> const& record, std::uint64_t count,
                                                  bool big_endian) {
  std::vector<unsigned char> bytes(count * 4);
  bool good = true;
  std::uint64_t at = 0;
  for (auto const& s : record) {
    std::uint64_t const n = std::min<std::uint64_t>(s.count, bytes.size() - at);
    good = good && file.read(s.at, bytes.data() + at, n);
    at += n;
  }
  if (!good || at != bytes.size()) return std::nullopt;
  std::vector<std::int64_t> out;
  for (std::uint64_t n = 0; n < count; ++n) out.push_back(to_integer(bytes.data() + 4 * n, 4, big_endian));
  return out;
}

/// The record markers of a whole file: payload segments of each record.
struct Records {
  std::vector<std::vector<Segment>> all;
  std::optional<std::string> broken;  ///< where the markers stop making sense

  [[nodiscard]] std::uint64_t size(std::size_t r) const {
    std::uint64_t sum = 0;
    for (auto const& s : all[r]) sum += s.count;
    return sum;
  }
};

/// Compilers split records of more than 2 GB: the count before a part is negative when another part follows.
Records walk_records(Bytes& file, int marker, bool big_endian) {
  Records out;
  std::uint64_t at = 0;
  bool continues = false;
  auto const width = std::uint64_t(marker);
  while (at < file.size() && out.all.size() < most_records) {
    unsigned char bytes[8];
    auto const number = std::to_string(out.all.size() + (continues ? 0 : 1));
    if (!file.read(at, bytes, width)) {
      out.broken = "the file ends in the byte count of record " + number + " at byte " + std::to_string(at);
      return out;
    }
    std::int64_t const lead = to_integer(bytes, marker, big_endian);
    std::uint64_t const count = lead < 0 ? 0 - std::uint64_t(lead) : std::uint64_t(lead);
    if (count > file.size() - at - width || file.size() - at - width - count < width) {
      out.broken = "record " + number + " at byte " + std::to_string(at) + " should have " + std::to_string(count) +
                   " bytes, but the file ends before";
      return out;
    }
    if (!file.read(at + width + count, bytes, width)) break;
    std::int64_t const trail = to_integer(bytes, marker, big_endian);
    if ((trail < 0 ? 0 - std::uint64_t(trail) : std::uint64_t(trail)) != count) {
      out.broken = "record " + number + " at byte " + std::to_string(at) + " has " + std::to_string(count) +
                   " bytes by the count before it and " + std::to_string(trail) + " by the count behind it";
      return out;
    }
    if (!continues) out.all.emplace_back();
    out.all.back().push_back({at + width, count});
    continues = lead < 0;
    at += 2 * width + count;
  }
  if (at < file.size()) out.broken = "there are more than " + std::to_string(most_records) + " records";
  return out;
}

/// Bytes [begin, begin + count) of a record, split or not.
void append_part(std::vector<Segment> const& record, std::uint64_t begin, std::uint64_t count,
                 std::vector<Segment>& out) {
  ZoneData whole;
  whole.segments = record;
  for_each_piece(whole, begin, count, [&](std::uint64_t at, std::uint64_t, std::uint64_t n) {
    out.push_back({at, n});
  });
}

/// The segments of a zone whose plane k is all of planes[k]: x of the plane, then y, (z), (iblank).
std::vector<Segment> from_planes(std::vector<std::vector<Segment>> const& planes, std::uint64_t nodes,
                                 Variant const& v) {
  std::vector<Segment> out;
  std::uint64_t const width = std::uint64_t(v.coordinate_bytes()), components = std::uint64_t(v.dimensions);
  for (std::uint64_t c = 0; c < components; ++c)
    for (auto const& plane : planes) append_part(plane, c * nodes * width, nodes * width, out);
  for (auto const& plane : planes)
    if (v.iblank) append_part(plane, components * nodes * width, nodes * 4, out);
  return out;
}

/// Tries a file of Fortran records with markers of one kind. Each step returns whether the next one makes sense; where
/// it does not, the candidate says why, unless nothing in the file speaks for a PLOT3D file.
class UnformattedTrial {
 public:
  UnformattedTrial(Bytes& file, int marker, bool big_endian, Stated const& stated)
      : file_(file), big_endian_(big_endian), stated_(stated), records_(walk_records(file, marker, big_endian)) {
    variant().storage = Storage::unformatted;
    variant().marker_bytes = marker;
    variant().big_endian = big_endian;
  }

  void run(std::vector<Candidate>& out) {
    if (records_.all.empty()) return;
    candidate_.fits = read_header() && take_extents() && count_records() && take_coordinates();
    if (candidate_.fits || candidate_.agreement > 0) out.push_back(std::move(candidate_));
  }

 private:
  Variant& variant() { return candidate_.layout.variant; }
  std::vector<ZoneData>& zones() { return candidate_.layout.zones; }

  bool give_up(int agreement, std::string why) {
    candidate_.agreement = agreement;
    candidate_.why = std::move(why);
    return false;
  }

  /// Header: [number of zones] and the extents.
  bool read_header() {
    std::uint64_t const first = records_.size(0);
    variant().multi_block = first == 4;
    if (variant().multi_block) return read_many_extents();
    if (first != 8 && first != 12) return false;  // any file of Fortran records
    variant().dimensions = int(first / 4);
    auto const all = integers(file_, records_.all[0], first / 4, big_endian_);
    if (!all) return false;
    sizes_ = *all;
    return true;
  }

  bool read_many_extents() {
    auto const count = integers(file_, records_.all[0], 1, big_endian_);
    if (!count || count->front() < 1 || count->front() > most_zones)
      return give_up(1, "its first record says that it has " + std::to_string(count ? count->front() : 0) + " zones");
    if (records_.all.size() < 2)
      return give_up(1, records_.broken.value_or("it has no record with the extents of the zones"));
    std::uint64_t const second = records_.size(1), n = std::uint64_t(count->front());
    variant().dimensions = second == 8 * n ? 2 : 3;
    if (second != 4 * n * std::uint64_t(variant().dimensions))
      return give_up(
          1, "the record with the extents of " + std::to_string(n) + " zones has " + std::to_string(second) + " bytes");
    auto const all = integers(file_, records_.all[1], second / 4, big_endian_);
    if (!all) return give_up(1, "the extents of its zones cannot be read");
    sizes_ = *all;
    header_ = 2;
    return true;
  }

  bool take_extents() {
    auto found = zones_of(sizes_, variant().dimensions, file_.size());
    if (!found) return give_up(1, "the extents of its zones are not those of a file of this size");
    zones() = std::move(*found);
    if (records_.broken) return give_up(3, *records_.broken + " (" + extents_text(zones()) + ")");
    return true;
  }

  /// There is one record for each zone, or for each plane of one.
  bool count_records() {
    std::size_t const found = records_.all.size() - header_;
    std::size_t planes = 0;
    for (auto const& zone : zones()) planes += std::size_t(zone.extent[2]);
    variant().planes = found == planes && (found != zones().size() || stated_.planes.value_or(false));
    if (found == (variant().planes ? planes : zones().size())) return true;
    return give_up(2, "it has " + std::to_string(found) + " records of coordinates for " +
                          std::to_string(zones().size()) + " zones with " + std::to_string(planes) +
                          " planes k; each zone, or each of its planes, must be one record");
  }

  [[nodiscard]] std::size_t records_of(ZoneData const& zone) const {
    return std::size_t(candidate_.layout.variant.planes ? zone.extent[2] : 1);
  }
  /// Nodes in each record of a zone.
  [[nodiscard]] std::uint64_t nodes_of(ZoneData const& zone) const {
    return std::uint64_t(zone.nodes()) / records_of(zone);
  }

  /// The first record says what a node has. Returns false where that is nothing that nodes have.
  bool find_contents() {
    std::uint64_t const bytes = records_.size(header_), nodes = nodes_of(zones().front());
    Variant const plain = variant();
    bool known = false;
    for (bool const wide : {false, true})
      for (bool const blank : {false, true}) {
        Variant tried = plain;
        tried.double_precision = wide;
        tried.iblank = blank;
        if (bytes != nodes * std::uint64_t(tried.bytes_per_node())) continue;
        variant() = tried;
        known = true;
      }
    return known;
  }

  /// All records must agree with the first one.
  bool take_coordinates() {
    bool const known = find_contents();
    std::size_t record = header_;
    for (std::size_t z = 0; z < zones().size(); ++z) {
      auto& zone = zones()[z];
      std::uint64_t const wanted = nodes_of(zone) * std::uint64_t(variant().bytes_per_node());
      std::vector<std::vector<Segment>> parts;
      for (std::size_t k = 0; k < records_of(zone); ++k, ++record) {
        if (!known || records_.size(record) != wanted) return refuse_record(z, k, records_.size(record));
        parts.push_back(records_.all[record]);
      }
      zone.segments = variant().planes ? from_planes(parts, nodes_of(zone), variant()) : std::move(parts.front());
    }
    return true;
  }

  bool refuse_record(std::size_t z, std::size_t k, std::uint64_t bytes) {
    auto const& extent = zones()[z].extent;
    return give_up(3, "the record of " +
                          (variant().planes ? "plane k = " + std::to_string(k + 1) + " of " : std::string()) + "zone " +
                          std::to_string(z + 1) + " (" + std::to_string(extent[0]) + " x " + std::to_string(extent[1]) +
                          " x " + std::to_string(extent[2]) + " nodes) has " + std::to_string(bytes) +
                          " bytes, which is no whole set of coordinates, with or without iblank");
  }

  Bytes& file_;
  bool big_endian_;
  Stated const& stated_;
  Records const records_;
  Candidate candidate_;
  std::vector<std::int64_t> sizes_;  ///< the extents of all zones
  std::size_t header_ = 1;           ///< records of the header
};

void try_binary(Bytes& file, bool big_endian, Stated const& stated, std::vector<Candidate>& out) {
  for (bool const multi : {true, false})
    for (int const dimensions : {3, 2}) {
      Candidate c;
      auto& v = c.layout.variant;
      v.storage = Storage::binary;
      v.big_endian = big_endian;
      v.multi_block = multi;
      v.dimensions = dimensions;
      v.planes = stated.planes.value_or(false);  // nothing in the file would tell
      std::uint64_t n = 1, at = 0;
      if (multi) {
        auto const count = integers(file, 0, 1, big_endian);
        if (!count || count->front() < 1 || count->front() > most_zones) continue;
        n = std::uint64_t(count->front());
        at = 4;
      }
      auto const sizes = integers(file, at, n * std::uint64_t(dimensions), big_endian);
      if (!sizes) continue;
      auto zones = zones_of(*sizes, dimensions, file.size());
      if (!zones) continue;
      at += 4 * sizes->size();
      std::uint64_t nodes = 0;
      for (auto const& zone : *zones) nodes += std::uint64_t(zone.nodes());
      for (bool const wide : {true, false})
        for (bool const blank : {false, true}) {
          v.double_precision = wide;
          v.iblank = blank;
          std::uint64_t const per_node = std::uint64_t(v.bytes_per_node());
          c.layout.zones = *zones;
          c.fits = nodes <= file.size() / per_node && at + nodes * per_node == file.size();
          c.agreement = 1;
          std::uint64_t const wanted = at + nodes * per_node;
          c.miss = wanted > file.size() ? wanted - file.size() : file.size() - wanted;
          c.why = "it should have " + std::to_string(wanted) + " bytes (" + extents_text(*zones) + "), but it has " +
                  std::to_string(file.size());
          std::uint64_t begin = at;
          for (auto& zone : c.layout.zones) {
            std::uint64_t const count = std::uint64_t(zone.nodes()) * per_node;
            zone.segments = {{begin, count}};
            if (v.planes && c.fits) {
              std::vector<std::vector<Segment>> planes;
              std::uint64_t const each = count / std::uint64_t(zone.extent[2]);
              for (int k = 0; k < zone.extent[2]; ++k) planes.push_back({{begin + std::uint64_t(k) * each, each}});
              zone.segments = from_planes(planes, std::uint64_t(zone.nodes() / zone.extent[2]), v);
            }
            begin += count;
          }
          out.push_back(c);
        }
    }
}

double to_real(unsigned char const* bytes, Variant const& v) {
  std::uint64_t value = 0;
  int const width = v.coordinate_bytes();
  for (int b = 0; b < width; ++b) value = (value << 8) | bytes[v.big_endian ? b : width - 1 - b];
  return v.double_precision ? std::bit_cast<double>(value) : double(std::bit_cast<float>(std::uint32_t(value)));
}

constexpr std::int64_t largest_mark = 1'000'000;

/// Bytes of a zone's data, wherever they are in the file.
bool read_data(Bytes& file, ZoneData const& zone, std::uint64_t begin, std::vector<unsigned char>& to) {
  bool good = true;
  std::uint64_t found = 0;
  for_each_piece(zone, begin, to.size(), [&](std::uint64_t at, std::uint64_t before, std::uint64_t n) {
    good = good && file.read(at, to.data() + before, n);
    found += n;
  });
  return good && found == to.size();
}

/// Whether the first thousands of numbers of every zone look like coordinates and the marks of iblank like marks.
bool looks_sane(Bytes& file, FileLayout const& layout) {
  constexpr Index sample = 4096;
  constexpr double largest = 1e20, smallest = 1e-30;
  auto const& v = layout.variant;
  for (auto const& zone : layout.zones) {
    std::uint64_t const nodes = std::uint64_t(zone.nodes()), width = std::uint64_t(v.coordinate_bytes());
    std::uint64_t const count = std::uint64_t(std::min(zone.nodes(), sample));
    std::vector<unsigned char> bytes(count * width);
    for (int c = 0; c < v.dimensions; ++c) {
      if (!read_data(file, zone, std::uint64_t(c) * nodes * width, bytes)) return false;
      for (std::uint64_t n = 0; n < count; ++n) {
        double const x = std::fabs(to_real(bytes.data() + n * width, v));
        if (!(x <= largest) || (x != 0 && x < smallest)) return false;
      }
    }
    if (!v.iblank) continue;
    bytes.resize(count * 4);
    if (!read_data(file, zone, nodes * width * std::uint64_t(v.dimensions), bytes)) return false;
    for (std::uint64_t n = 0; n < count; ++n)
      if (std::int64_t const m = to_integer(bytes.data() + 4 * n, 4, v.big_endian);
          m < -largest_mark || m > largest_mark)
        return false;
  }
  return true;
}

}  // namespace

FileLayout detect_binary(std::string const& path, Stated const& stated) {
  Bytes file(path);
  std::vector<Candidate> tried;
  for (bool const big_endian : {false, true}) {
    for (int const marker : {4, 8}) UnformattedTrial(file, marker, big_endian, stated).run(tried);
    try_binary(file, big_endian, stated, tried);
  }
  std::erase_if(tried, [&](Candidate const& c) { return !stated.allows(c.layout.variant); });
  // Record markers around a header that makes sense are no accident. Files without markers have nothing but their
  // numbers to be known by.
  auto const has_records = [](Candidate const& c) {
    return c.layout.variant.storage == Storage::unformatted && (c.fits || c.agreement > 1);
  };
  if (std::any_of(tried.begin(), tried.end(), has_records))
    std::erase_if(tried, [&](Candidate const& c) { return !has_records(c); });
  std::vector<Candidate> good;
  for (auto& c : tried) {
    if (!c.fits) continue;
    if (c.layout.variant.storage == Storage::unformatted || stated.storage || looks_sane(file, c.layout)) {
      good.push_back(c);
    } else {
      c.fits = false;
      c.miss = 0;
      c.why = "its numbers are no coordinates (" + extents_text(c.layout.zones) + ")";
    }
  }
  if (good.size() > 1)
    if (auto sane = good;
        std::erase_if(sane, [&](Candidate const& c) { return !looks_sane(file, c.layout); }) > 0 && !sane.empty())
      good = std::move(sane);
  if (good.size() == 1) return std::move(good.front().layout);
  if (good.size() > 1) {
    std::string text =
        path + ": could be several kinds of PLOT3D files; state which with format = \"...\" in its side file:";
    for (auto const& c : good) text += "\n  " + to_string(c.layout.variant) + ": " + extents_text(c.layout.zones);
    throw IoError(text);
  }
  auto const nearest = std::min_element(tried.begin(), tried.end(), [](Candidate const& a, Candidate const& b) {
    return std::pair(-a.agreement, a.miss) < std::pair(-b.agreement, b.miss);
  });
  if (nearest != tried.end() && (nearest->agreement > 1 || stated.storage))
    throw IoError(path + ": begins as a PLOT3D file (" + to_string(nearest->layout.variant) + "), but " + nearest->why +
                  "; it is cut short or damaged: transfer or write it again");
  throw IoError(path + ": is not a CGNS file (neither HDF5 nor ADF by its first bytes), and " +
                (nearest == tried.end()
                     ? "no variant of PLOT3D fits its first numbers"
                     : "as PLOT3D file (" + to_string(nearest->layout.variant) + ") " + nearest->why) +
                "; name a mesh file, or state its format in its side file");
}

}  // namespace gridmorph::plot3d
