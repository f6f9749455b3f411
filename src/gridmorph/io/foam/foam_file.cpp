#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/io/foam/foam_file.hpp>
#include <gridmorph/io/printable.hpp>
#include <gridmorph/io/read_file.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#ifdef GRIDMORPH_WITH_ZLIB
#include <zlib.h>
#endif

namespace gridmorph::foam {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool ends_word(char c) { return is_blank(c) || std::strchr("(){};\"", c) != nullptr; }

#ifdef GRIDMORPH_WITH_ZLIB
/// zlib's header and tail are those of gzip.
constexpr int gzip_window = 15 + 16;

/// Text of meshes is packed to a fifteenth at best, damaged or evil files to a thousandth (RFC 1951).
constexpr std::size_t most_expansion = 100, always_allowed = 16u << 20;

/// Hands all bytes to step(last piece), which is inflate or deflate, and gathers what comes out, up to `most` bytes and
/// a piece. Returns the state at the end.
template <class Step>
int stream_through(z_stream& stream, std::string const& bytes, std::string& out, std::size_t most, Step const& step) {
  constexpr std::size_t largest_piece = std::size_t(1) << 30;
  std::vector<char> chunk(std::size_t(1) << 20);
  std::size_t given = 0;
  int state = Z_OK;
  do {
    std::size_t const give = std::min(largest_piece, bytes.size() - given);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + given));
    stream.avail_in = uInt(give);
    given += give;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
      stream.avail_out = uInt(chunk.size());
      state = step(given == bytes.size());
      out.append(chunk.data(), chunk.size() - stream.avail_out);
    } while (state == Z_OK && out.size() <= most && (stream.avail_out == 0 || stream.avail_in > 0));
  } while ((state == Z_OK || state == Z_BUF_ERROR) && out.size() <= most && given < bytes.size());
  return state;
}

std::string unpacked(std::string const& path, std::string const& bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, gzip_window) != Z_OK) throw MachineError(path + ": zlib cannot be started");
  std::string out;
  std::size_t const most = always_allowed + most_expansion * bytes.size();
  int const state = stream_through(stream, bytes, out, most, [&](bool) {
    int const now = inflate(&stream, Z_NO_FLUSH);
    if (now != Z_STREAM_END || stream.avail_in == 0) return now;
    return inflateReset(&stream);  // gzip files may follow one another
  });
  inflateEnd(&stream);
  if (out.size() > most)
    throw IoError(path + ": unpacks to more than " + std::to_string(most_expansion) + " times its " +
                  std::to_string(bytes.size()) +
                  " bytes, which no mesh does; if the file is sound, unpack it (gunzip)");
  if (state != Z_STREAM_END)
    throw IoError(path + ": is damaged: the packed data end or go wrong after " + std::to_string(out.size()) +
                  " bytes; write it again");
  return out;
}

std::string deflated(std::string const& path, std::string const& bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_window, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw MachineError(path + ": zlib cannot be started");
  std::string out;
  stream_through(stream, bytes, out, std::numeric_limits<std::size_t>::max() / 2,
                 [&](bool last) { return deflate(&stream, last ? Z_FINISH : Z_NO_FLUSH); });
  deflateEnd(&stream);
  return out;
}
#else
std::string unpacked(std::string const& path, std::string const&) {
  throw IoError(path + ": is packed by gzip, and this gridmorph was built without zlib; unpack it first");
}

std::string deflated(std::string const& path, std::string const&) {
  throw IoError(path + ": is to be packed by gzip, and this gridmorph was built without zlib");
}
#endif

}  // namespace

std::string packed(std::string const& path, std::string const& bytes) { return deflated(path, bytes); }

bool is_there(std::string const& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) || std::filesystem::is_regular_file(path + ".gz", ignored);
}

std::string_view BoundaryEntry::operator[](std::string_view key) const {
  auto const found = std::find_if(keys.begin(), keys.end(), [&](auto const& k) { return k.first == key; });
  return found == keys.end() ? std::string_view() : std::string_view(found->second);
}

FoamFile::FoamFile(std::string const& path, std::vector<std::string_view> const& classes) : path_(path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path_, ignored) && std::filesystem::exists(path_ + ".gz", ignored)) path_ += ".gz";
  text_ = io::read_file(path_);
  packed_ = text_.size() > 1 && text_[0] == '\x1f' && text_[1] == '\x8b';
  if (packed_) text_ = unpacked(path_, text_);
  read_header(classes);
}

void FoamFile::fail(std::string const& what) const {
  auto const line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(std::min(at_, text_.size())), '\n');
  throw IoError(path_ + (binary_ ? ", byte " + std::to_string(at_) : ":" + std::to_string(line)) + ": " + what);
}

void FoamFile::skip_blanks() {
  while (at_ < text_.size()) {
    if (is_blank(text_[at_])) {
      ++at_;
    } else if (text_.compare(at_, 2, "//") == 0) {
      at_ = std::min(text_.find('\n', at_), text_.size());
    } else if (text_.compare(at_, 2, "/*") == 0) {
      auto const end = text_.find("*/", at_ + 2);
      if (end == std::string::npos) fail("a comment that begins here does not end");
      at_ = end + 2;
    } else {
      return;
    }
  }
}

char FoamFile::peek() {
  skip_blanks();
  return at_ < text_.size() ? text_[at_] : '\0';
}

void FoamFile::expect(char wanted, char const* after) {
  char const found = peek();
  if (found != wanted)
    fail(std::string("'") + wanted + "' has to follow " + after + ", found " +
         (found == '\0' ? std::string("the end of the file") : "'" + std::string(1, found) + "'"));
  ++at_;
}

std::string FoamFile::word() {
  skip_blanks();
  if (at_ < text_.size() && text_[at_] == '"') {
    auto const end = text_.find('"', at_ + 1);
    if (end == std::string::npos) fail("a string that begins here does not end");
    std::string out = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return out;
  }
  std::size_t const begin = at_;
  while (at_ < text_.size() && !ends_word(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string FoamFile::value_of_key() {
  skip_blanks();
  std::string out;
  int depth = 0;
  // A dictionary is a value without ';': `surface { type none; }`.
  bool const dictionary = at_ < text_.size() && text_[at_] == '{';
  while (true) {
    if (at_ >= text_.size()) fail("a value does not end; ';' is missing");
    char const c = text_[at_];
    if (c == '"') {
      auto const end = text_.find('"', at_ + 1);
      if (end == std::string::npos) fail("a string that begins here does not end");
      out.append(text_, at_, end + 1 - at_);
      at_ = end + 1;
      continue;
    }
    if (c == ';' && depth == 0) {
      ++at_;
      break;
    }
    if (c == '}' && depth == 0) fail("';' is missing before '}'");
    depth += c == '(' || c == '{' ? 1 : c == ')' || c == '}' ? -1 : 0;
    out += c;
    ++at_;
    if (dictionary && depth == 0) {
      if (peek() == ';') ++at_;
      break;
    }
  }
  while (!out.empty() && is_blank(out.back())) out.pop_back();
  return out;
}

void FoamFile::read_header(std::vector<std::string_view> const& classes) {
  if (word() != "FoamFile") {
    at_ = 0;
    fail("is no file of an OpenFOAM mesh: it does not begin with FoamFile");
  }
  expect('{', "FoamFile");
  std::string arch;
  while (peek() != '}') {
    std::string const key = word();
    if (key.empty()) fail("a key of the header is missing");
    std::string value = value_of_key();
    if (value.size() > 1 && value.front() == '"') value = value.substr(1, value.size() - 2);
    if (key == "class") class_ = value;
    if (key == "format" && value != "ascii" && value != "binary")
      fail("the format is '" + value + "'; ascii and binary are read");
    if (key == "format") binary_ = value == "binary";
    if (key == "arch") arch = value;
  }
  expect('}', "the header");
  if (arch.find("MSB") != std::string::npos && binary_)
    fail("holds numbers of the other byte order (arch " + arch + "); write it again as ascii (foamFormatConvert)");
  auto const bytes_of = [&](std::string_view key, int otherwise) {
    auto const place = arch.find(key);
    return place == std::string::npos ? otherwise : std::atoi(arch.c_str() + place + key.size()) / 8;
  };
  label_bytes_ = bytes_of("label=", label_bytes_);
  scalar_bytes_ = bytes_of("scalar=", scalar_bytes_);
  if ((label_bytes_ != 4 && label_bytes_ != 8) || (scalar_bytes_ != 4 && scalar_bytes_ != 8))
    fail("numbers of " + arch + " are not read; 32 and 64 bits are");
  if (std::find(classes.begin(), classes.end(), class_) == classes.end())
    fail("the class is '" + class_ + "', and " + std::string(classes.front()) + " is wanted");
  body_ = at_;
}

std::int64_t FoamFile::integer(char const* what) {
  skip_blanks();
  std::int64_t value = 0;
  auto const [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
  if (error != std::errc()) fail(std::string(what) + ": a whole number is missing");
  at_ = std::size_t(end - text_.data());
  return value;
}

double FoamFile::number(std::size_t& begin, std::size_t& end) {
  skip_blanks();
  begin = end = at_;
  while (end < text_.size() && !ends_word(text_[end])) ++end;
  std::string_view const found = std::string_view(text_).substr(begin, end - begin);
  auto const value = to_number(found);
  if (!value) fail("a coordinate is missing, or no number" + (found.empty() ? "" : ": '" + io::printable(found) + "'"));
  if (std::isinf(*value))
    fail("the coordinate '" + io::printable(found) + "' is larger than any number that can be computed with");
  at_ = end;
  return *value;
}

Index FoamFile::begin_list(char const* what, Index least_bytes, Index most_alike, char& bracket) {
  std::int64_t const n = integer(what);
  // Every value takes some bytes, so that a damaged length asks for no more memory than the file is long. The last one
  // of a text ends with the list.
  bracket = peek();
  std::size_t const after = at_ + 1, left = text_.size() - std::min(after, text_.size()) + (binary_ ? 0 : 1);
  if (bracket == '{' && n > most_alike)
    fail(std::string(what) + ": a list of " + std::to_string(n) + " values that are all alike; at most " +
         std::to_string(most_alike) + " can be here");
  if (n < 0 || n > std::numeric_limits<Index32>::max() ||
      (bracket != '{' && std::uint64_t(n) * std::uint64_t(least_bytes) > left))
    fail(std::string(what) + ": a list of " + std::to_string(n) + " does not fit into the file");
  if (bracket != '(' && bracket != '{') {
    if (n == 0) return 0;
    fail(std::string(what) + ": '(' has to follow the length of a list");
  }
  ++at_;
  return n;
}

std::int64_t FoamFile::raw_label() {
  std::int64_t value = 0;
  if (label_bytes_ == 8) {
    std::memcpy(&value, text_.data() + at_, sizeof value);
  } else {
    std::int32_t four = 0;
    std::memcpy(&four, text_.data() + at_, sizeof four);
    value = four;
  }
  at_ += std::size_t(label_bytes_);
  return value;
}

std::vector<std::int64_t> FoamFile::raw_list(char const* what, Index most_alike) {
  char bracket = 0;
  Index const n = begin_list(what, binary_ ? label_bytes_ : 2, most_alike, bracket);
  std::vector<std::int64_t> out;
  if (n == 0 && bracket != '(') return out;
  out.reserve(n);
  if (bracket == '{') {
    out.assign(n, integer(what));
    expect('}', "the value of a list");
    return out;
  }
  for (Index k = 0; k < n; ++k) out.push_back(binary_ ? raw_label() : integer(what));
  expect(')', "a list");
  return out;
}

void FoamFile::pass_list(char const* what, int bytes) {
  char bracket = 0;
  Index const n = begin_list(what, binary_ ? bytes : 1, std::numeric_limits<Index32>::max(), bracket);
  if (n == 0 && bracket != '(') return;
  if (binary_ && bracket == '(')
    at_ += std::size_t(n) * std::size_t(bytes);
  else
    while (at_ < text_.size() && text_[at_] != (bracket == '(' ? ')' : '}')) ++at_;
  expect(bracket == '(' ? ')' : '}', what);
}

std::vector<ZoneEntry> FoamFile::zones(std::string_view wanted, Index n_labels) {
  at_ = body_;
  char bracket = 0;
  constexpr Index shortest = 4;  // "a{}\n"
  Index const n = begin_list("zones", shortest, 1, bracket);
  if (n == 0 && bracket != '(') return {};
  if (bracket == '{') fail("zones are listed one by one");
  std::vector<ZoneEntry> out;
  for (Index z = 0; z < n; ++z) {
    ZoneEntry entry;
    entry.name = word();
    if (entry.name.empty()) fail("the name of a zone is missing");
    expect('{', "the name of a zone");
    while (peek() != '}') {
      std::string const key = word();
      if (key.empty()) fail("zone '" + entry.name + "': a key is missing");
      std::size_t const before = at_;
      std::string const type = word();
      if (!type.starts_with("List<")) {
        at_ = before;
        (void)value_of_key();
        continue;
      }
      if (key != wanted) {
        pass_list("a list of a zone", type == "List<bool>" ? 1 : label_bytes_);
      } else {
        for (auto const v : raw_list("the labels of a zone", n_labels)) {
          if (v < 0 || v >= n_labels)
            throw MeshError(path_ + ": zone '" + entry.name + "' names " + std::string(wanted) + " " +
                            std::to_string(v) + ", and there are " + std::to_string(n_labels) + ", counted from 0");
          entry.labels.push_back(Index32(v));
        }
      }
      expect(';', "a list of a zone");
    }
    expect('}', "the keys of a zone");
    std::sort(entry.labels.begin(), entry.labels.end());
    entry.labels.erase(std::unique(entry.labels.begin(), entry.labels.end()), entry.labels.end());
    out.push_back(std::move(entry));
  }
  expect(')', "the zones");
  return out;
}

std::vector<Index32> FoamFile::labels(Index most, std::int64_t least) {
  at_ = body_;
  auto const all = raw_list("labels", most);
  std::vector<Index32> out;
  out.reserve(all.size());
  for (auto const v : all) {
    if (v < least || v > std::numeric_limits<Index32>::max())
      fail("the label " + std::to_string(v) + " is out of range");
    out.push_back(Index32(v));
  }
  return out;
}

CsrGraph FoamFile::faces() {
  at_ = body_;
  CsrGraph out;
  auto const node = [&](std::int64_t v) {
    if (v < 0 || v > std::numeric_limits<Index32>::max()) fail("a face has node " + std::to_string(v));
    return Index32(v);
  };
  if (class_ == "faceCompactList") {
    auto const first = raw_list("places of faces", 1), nodes = raw_list("nodes of faces", 1);
    for (std::size_t f = 0; f < first.size(); ++f)
      if (first[f] < (f == 0 ? 0 : first[f - 1]) || (f + 1 == first.size() && first[f] != std::int64_t(nodes.size())) ||
          (f == 0 && first[f] != 0))
        fail("place " + std::to_string(f) + " of the faces, " + std::to_string(first[f]) + ", does not fit the " +
             std::to_string(nodes.size()) + " nodes that follow");
    if (!first.empty()) out.first.assign(first.begin(), first.end());
    out.item.reserve(nodes.size());
    for (auto const v : nodes) out.item.push_back(node(v));
    return out;
  }
  char bracket = 0;
  constexpr Index shortest = 8;  // "3(0 1 2)"
  Index const n = begin_list("faces", binary_ ? 1 : shortest, 1, bracket);
  if (n == 0 && bracket != '(') return out;
  if (bracket == '{') fail("faces are listed one by one");
  std::vector<Index32> face;
  for (Index f = 0; f < n; ++f) {
    face.clear();
    for (auto const v : raw_list("a face", 1)) face.push_back(node(v));
    out.add(face);
  }
  expect(')', "the faces");
  return out;
}

Index FoamFile::points(std::function<void(PointText const&)> const& visit) {
  at_ = body_;
  char bracket = 0;
  constexpr Index shortest = 7;  // "(0 0 0)"
  Index const n = begin_list("points", binary_ ? 3 * scalar_bytes_ : shortest, 1, bracket);
  if (n == 0 && bracket != '(') return 0;
  if (bracket == '{') fail("points are listed one by one");
  PointText text;
  for (text.point = 0; text.point < n; ++text.point) {
    if (!binary_) expect('(', "a point");
    for (text.component = 0; text.component < 3; ++text.component) {
      if (!binary_) {
        text.value = number(text.begin, text.end);
      } else {
        text.begin = at_;
        text.end = at_ += std::size_t(scalar_bytes_);
        if (scalar_bytes_ == 8) {
          std::memcpy(&text.value, text_.data() + text.begin, sizeof text.value);
        } else {
          float single = 0;
          std::memcpy(&single, text_.data() + text.begin, sizeof single);
          text.value = double(single);
        }
      }
      visit(text);
    }
    if (!binary_) expect(')', "the coordinates of a point");
  }
  expect(')', "the points");
  return n;
}

Coordinates FoamFile::coordinates() {
  std::vector<double> all;
  Coordinates out(points([&](PointText const& p) { all.push_back(p.value); }));
  for (Index p = 0; p < out.size(); ++p)
    out.set(p, {all[3 * p], all[std::size_t(3 * p) + 1], all[std::size_t(3 * p) + 2]});
  return out;
}

void FoamFile::find_faces(std::vector<BoundaryEntry>& entries, Index n_faces) const {
  Problems problems;
  for (BoundaryEntry& entry : entries) {
    std::string const where = path_ + ":" + std::to_string(entry.line) + ": patch '" + entry.name + "'";
    auto const value = [&](char const* key) {
      std::string const text(entry[key]);
      char* end = nullptr;
      long long const n = std::strtoll(text.c_str(), &end, 10);
      if (text.empty() || *end != '\0' || n < 0 || n > n_faces)
        problems.add(where + ": " + key + " is '" + text + "', and there are " + std::to_string(n_faces) + " faces");
      return Index(std::clamp<long long>(n, 0, n_faces));
    };
    entry.start = value("startFace");
    entry.size = value("nFaces");
    if (entry.start + entry.size > n_faces)
      problems.add(where + " ends behind the last of " + std::to_string(n_faces) + " faces");
  }
  problems.throw_if_any<MeshError>();
}

std::vector<BoundaryEntry> FoamFile::boundary(Index n_faces) {
  at_ = body_;
  // Dictionaries are text in binary files too.
  binary_ = false;
  char bracket = 0;
  constexpr Index shortest = 4;  // "a{}\n"
  Index const n = begin_list("patches", shortest, 1, bracket);
  if (n == 0 && bracket != '(') return {};
  if (bracket == '{') fail("patches are listed one by one");
  std::vector<BoundaryEntry> out;
  auto counted = text_.begin();
  int line = 1;
  for (Index p = 0; p < n; ++p) {
    BoundaryEntry entry;
    entry.name = word();
    auto const here = text_.begin() + std::ptrdiff_t(at_);
    entry.line = line += int(std::count(counted, here, '\n'));
    counted = here;
    if (entry.name.empty()) fail("the name of a patch is missing");
    expect('{', "the name of a patch");
    while (peek() != '}') {
      std::string key = word();
      if (key.empty()) fail("patch '" + entry.name + "': a key is missing");
      std::string value = value_of_key();
      entry.keys.emplace_back(std::move(key), std::move(value));
    }
    expect('}', "the keys of a patch");
    out.push_back(std::move(entry));
  }
  expect(')', "the patches");
  find_faces(out, n_faces);
  return out;
}

}  // namespace gridmorph::foam
