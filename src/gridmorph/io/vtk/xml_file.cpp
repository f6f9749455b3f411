#include <gridmorph/core/error.hpp>
#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/printable.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/replaced_text.hpp>
#include <gridmorph/io/vtk/base64.hpp>
#include <gridmorph/io/vtk/xml_file.hpp>
#include <gridmorph/io/zlib_blocks.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

namespace gridmorph::vtk {

namespace {

constexpr std::size_t block_bytes = 32768;  // VTK's own

void swap_bytes(std::string& bytes, std::size_t size) {
  for (std::size_t at = 0; at + size <= bytes.size(); at += size)
    std::reverse(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at + size));
}

/// Calls visit(type's zero) for a type name of VTK; false for others.
template <class Visit>
bool with_type(std::string_view name, Visit const& visit) {
  if (name == "Float64")
    visit(double());
  else if (name == "Float32")
    visit(float());
  else if (name == "Int64")
    visit(std::int64_t());
  else if (name == "UInt64")
    visit(std::uint64_t());
  else if (name == "Int32")
    visit(std::int32_t());
  else if (name == "UInt32")
    visit(std::uint32_t());
  else if (name == "Int16")
    visit(std::int16_t());
  else if (name == "UInt16")
    visit(std::uint16_t());
  else if (name == "Int8")
    visit(std::int8_t());
  else if (name == "UInt8")
    visit(std::uint8_t());
  else
    return false;
  return true;
}

std::string describe(Tag const& array) { return "DataArray '" + std::string(array["Name"]) + "'"; }

}  // namespace

XmlFile::XmlFile(std::string const& path, std::vector<std::string_view> const& types)
    : path_(path), text_(io::read_file(path)), root_(parse_tags(path, text_)) {
  if (root_.name != "VTKFile") fail(root_, "is no file of VTK: its first tag is <" + root_.name + ">");
  if (std::find(types.begin(), types.end(), root_["type"]) == types.end())
    fail(root_, "is a VTK file of type " + std::string(root_["type"]) + ", and " + std::string(types.front()) +
                    " is wanted; open it in ParaView and save that");
  bool const big = root_["byte_order"] == "BigEndian";
  swapped_ = !root_["byte_order"].empty() && big != (std::endian::native == std::endian::big);
  auto const head = root_["header_type"];
  if (!head.empty() && head != "UInt32" && head != "UInt64")
    fail(root_, "header_type is " + std::string(head) + "; UInt32 and UInt64 are read");
  head_bytes_ = head == "UInt64" ? 8 : 4;
  auto const compressor = root_["compressor"];
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
    fail(root_, "arrays are packed by " + std::string(compressor) +
                    "; vtkZLibDataCompressor is read. Write the file with that, or without");
  packed_ = !compressor.empty();
  if (Tag const* appended = root_.child("AppendedData")) {
    appended_base64_ = (*appended)["encoding"] == "base64";
    if (!appended_base64_ && (*appended)["encoding"] != "raw")
      fail(*appended,
           "the encoding of AppendedData is '" + std::string((*appended)["encoding"]) + "'; raw and base64 are read");
    auto const mark = text_.find('_', appended->inside);
    if (mark == std::string::npos || mark >= appended->inside_end)
      fail(*appended, "AppendedData holds no '_', behind which its bytes begin");
    appended_begin_ = mark + 1;
    appended_end_ = appended->inside_end;
  }
  find_appended(root_);
}

void XmlFile::find_appended(Tag const& tag) {
  if (tag["format"] == "appended")
    if (auto const* offset = tag.attribute("offset")) offsets_.push_back(offset);
  for (Tag const& child : tag.children) find_appended(child);
}

XmlFile::Storage XmlFile::storage(Tag const& array) const {
  auto const format = array["format"];
  if (format == "ascii") return Storage::ascii;
  if (format == "binary") return Storage::binary;
  if (format == "appended") return Storage::appended;
  fail(array, describe(array) + " has the format '" + std::string(format) + "'; ascii, binary and appended are read");
}

std::string_view XmlFile::type(Tag const& array) const {
  if (!with_type(array["type"], [](auto) {}))
    fail(array, describe(array) + " is of type '" + std::string(array["type"]) + "', which is not read");
  return array["type"];
}

bool XmlFile::is_integer(Tag const& array) {
  bool out = false;
  with_type(array["type"], [&](auto zero) { out = std::is_integral_v<decltype(zero)>; });
  return out;
}

std::size_t XmlFile::value_bytes(Tag const& array) const {
  if (array["type"] == "String") return 1;
  std::size_t out = 0;
  with_type(type(array), [&](auto zero) { out = sizeof zero; });
  return out;
}

Index XmlFile::count(Tag const& tag, char const* attribute) const {
  auto const text = tag[attribute];
  Index value = -1;
  auto const [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || value < 0)
    fail(tag, "<" + tag.name + "> has " + attribute + "=\"" + std::string(text) + "\"; a whole number is wanted");
  return value;
}

std::string_view XmlFile::inline_text(Tag const& array) const {
  // Further tags (InformationKey) stand before or behind the numbers.
  std::size_t begin = array.inside;
  std::string_view longest;
  auto const take = [&](std::size_t end) {
    auto const piece = std::string_view(text_).substr(begin, end - begin);
    if (piece.find_first_not_of(" \t\r\n") != std::string_view::npos && longest.empty()) longest = piece;
  };
  for (Tag const& child : array.children) {
    take(child.begin);
    begin = child.end;
  }
  take(array.inside_end);
  return longest.empty() ? std::string_view(text_).substr(array.inside, 0) : longest;
}

std::uint64_t XmlFile::head_number(char const* bytes) const {
  std::uint64_t out = 0;
  std::string copy(bytes, head_bytes_);
  if (swapped_) std::reverse(copy.begin(), copy.end());
  if (head_bytes_ == 8) {
    std::memcpy(&out, copy.data(), 8);
  } else {
    std::uint32_t four = 0;
    std::memcpy(&four, copy.data(), 4);
    out = four;
  }
  return out;
}

void XmlFile::append_head_number(std::uint64_t value, std::string& out) const {
  std::string bytes(head_bytes_, '\0');
  auto const four = std::uint32_t(value);
  std::memcpy(bytes.data(), head_bytes_ == 8 ? static_cast<void const*>(&value) : &four, head_bytes_);
  if (swapped_) std::reverse(bytes.begin(), bytes.end());
  out += bytes;
}

XmlFile::Bytes XmlFile::bytes(Tag const& array) const {
  bool const appended = storage(array) == Storage::appended, base64 = !appended || appended_base64_;
  std::size_t begin = 0, end = 0;
  if (appended) {
    Index const offset = count(array, "offset");
    if (appended_begin_ == 0 || std::uint64_t(offset) > appended_end_ - appended_begin_)
      fail(array, describe(array) + " has offset " + std::to_string(offset) +
                      ", behind the end of AppendedData; get a whole copy of the file");
    begin = appended_begin_ + std::size_t(offset);
    end = appended_end_;
  } else {
    auto const text = inline_text(array);
    begin = std::size_t(text.data() - text_.data());
    end = begin + text.size();
    while (begin < end && io::is_blank(text_[begin])) ++begin;
    while (end > begin && io::is_blank(text_[end - 1])) --end;
  }
  auto const within = std::string_view(text_).substr(0, end);
  Base64Reader reader(within, begin);
  std::size_t at = begin;
  auto const read = [&](std::uint64_t n, char const* what) {
    std::optional<std::string> out;
    if (n <= end - begin) {
      if (base64) {
        out = reader.read(std::size_t(n));
      } else if (n <= end - at) {
        out = text_.substr(at, std::size_t(n));
        at += std::size_t(n);
      }
    }
    if (!out)
      fail(array, describe(array) + " ends amid " + what + ", of " + std::to_string(n) +
                      " bytes, or holds what is no base64; get a whole copy of the file");
    return *std::move(out);
  };
  Bytes out;
  out.begin = begin;
  if (!packed_) {
    out.bytes = read(head_number(read(head_bytes_, "its head").data()), "its values");
  } else {
    std::uint64_t const n = head_number(read(head_bytes_, "its head").data());
    if (n > end - begin)
      fail(array, describe(array) + " is said to be " + std::to_string(n) +
                      " packed blocks, more than the file can hold; get a whole copy of it");
    std::string const sizes = read((n + 2) * head_bytes_, "its head");
    std::uint64_t const whole = head_number(sizes.data()), last = head_number(sizes.data() + head_bytes_);
    for (std::uint64_t b = 0; b < n; ++b) {
      std::string const block = read(head_number(sizes.data() + (2 + b) * head_bytes_), "a packed block");
      auto const unpacked = io::unpacked_block(block, b + 1 == n && last > 0 ? last : whole);
      if (!unpacked)
        fail(array, describe(array) + ": packed block " + std::to_string(b + 1) + " of " + std::to_string(n) +
                        " is damaged, or this gridmorph was built without zlib");
      out.bytes += *unpacked;
    }
  }
  out.end = base64 ? reader.at() : at;
  std::size_t const size = value_bytes(array);
  if (out.bytes.size() % size != 0)
    fail(array, describe(array) + " holds " + std::to_string(out.bytes.size()) +
                    " bytes, no whole number of values of " + std::to_string(size));
  if (swapped_) swap_bytes(out.bytes, size);
  return out;
}

template <class T>
std::vector<T> XmlFile::words(Tag const& array) const {
  std::vector<T> out;
  auto const text = inline_text(array);
  char const *at = text.data(), *const end = at + text.size();
  while (true) {
    while (at < end && io::is_blank(*at)) ++at;
    if (at == end) return out;
    char const* stop = at;
    while (stop < end && !io::is_blank(*stop)) ++stop;
    T value{};
    auto const [read_to, failure] = std::from_chars(*at == '+' ? at + 1 : at, stop, value);
    if (failure != std::errc() || read_to != stop)
      fail_at(path_, text_, std::size_t(at - text_.data()),
              describe(array) + ": expected a number, found '" + io::printable({at, std::size_t(stop - at)}) + "'");
    out.push_back(value);
    at = stop;
  }
}

template <class T>
std::vector<T> XmlFile::values(Tag const& array, Index n) const {
  std::vector<T> out;
  if (storage(array) == Storage::ascii) {
    bool const single = type(array) == "Float32";
    out = words<T>(array);
    if (single && std::is_same_v<T, double>)
      for (T& value : out) value = T(float(value));
  } else {
    Bytes const found = bytes(array);
    with_type(type(array), [&](auto zero) {
      using Stored = decltype(zero);
      out.resize(found.bytes.size() / sizeof(Stored));
      for (std::size_t k = 0; k < out.size(); ++k) {
        Stored value;
        std::memcpy(&value, found.bytes.data() + k * sizeof(Stored), sizeof(Stored));
        out[k] = T(value);
      }
    });
  }
  if (n >= 0 && Index(out.size()) != n)
    fail(array, describe(array) + " holds " + std::to_string(out.size()) + " values, and " + std::to_string(n) +
                    " are wanted");
  return out;
}

std::vector<std::int64_t> XmlFile::integers(Tag const& array, Index n) const {
  if (!is_integer(array))
    fail(array, describe(array) + " is of type '" + std::string(array["type"]) + "', and whole numbers are wanted");
  return values<std::int64_t>(array, n);
}

std::vector<double> XmlFile::reals(Tag const& array, Index n) const { return values<double>(array, n); }

std::vector<double> XmlFile::coordinates(Tag const& array, Index n) const {
  if (is_integer(array))
    fail(array, describe(array) + " holds coordinates of type '" + std::string(array["type"]) +
                    "', whole numbers, which cannot hold where nodes move to; write them as Float64 or Float32");
  return reals(array, n);
}

std::vector<std::string> XmlFile::strings(Tag const& array) const {
  std::vector<std::string> out(1);
  auto const add = [&](char c) {
    if (c == 0)
      out.emplace_back();
    else
      out.back() += c;
  };
  if (storage(array) == Storage::ascii)
    for (std::int64_t const code : words<std::int64_t>(array)) add(char(code));
  else
    for (char const c : bytes(array).bytes) add(c);
  out.pop_back();
  return out;
}

std::string XmlFile::encoded(std::string bytes, std::size_t value_bytes, bool base64) const {
  if (swapped_) swap_bytes(bytes, value_bytes);
  std::string head, body;
  if (!packed_) {
    append_head_number(bytes.size(), head);
    head += bytes;
    return base64 ? to_base64(head) : head;
  }
  std::size_t const n = (bytes.size() + block_bytes - 1) / block_bytes;
  append_head_number(n, head);
  append_head_number(block_bytes, head);
  append_head_number(bytes.size() % block_bytes, head);
  for (std::size_t b = 0; b < n; ++b) {
    std::string const block = io::packed_block(path_, std::string_view(bytes).substr(b * block_bytes, block_bytes));
    append_head_number(block.size(), head);
    body += block;
  }
  return base64 ? to_base64(head) + to_base64(body) : head + body;
}

void XmlFile::replace(Tag const& array, std::span<double const> values, std::vector<Edit>& edits) const {
  if (storage(array) == Storage::ascii) {
    auto const before = reals(array, Index(values.size()));
    auto const text = inline_text(array);
    bool const single = type(array) == "Float32";
    std::size_t at = std::size_t(text.data() - text_.data());
    for (std::size_t n = 0; n < values.size(); ++n) {
      while (io::is_blank(text_[at])) ++at;
      std::size_t end = at;
      while (end < text_.size() && !io::is_blank(text_[end]) && text_[end] != '<') ++end;
      double const to = single ? double(float(values[n])) : values[n];
      if (std::bit_cast<std::uint64_t>(to) != std::bit_cast<std::uint64_t>(before[n])) {
        std::array<char, 32> digits{};
        auto const last = single ? std::to_chars(digits.data(), digits.data() + digits.size(), float(to)).ptr
                                 : std::to_chars(digits.data(), digits.data() + digits.size(), to).ptr;
        edits.push_back({at, end, std::string(digits.data(), last)});
      }
      at = end;
    }
    return;
  }
  Bytes const before = bytes(array);
  std::string after(before.bytes.size(), '\0');
  std::size_t const size = value_bytes(array);
  if (before.bytes.size() != size * values.size())
    fail(array, describe(array) + " holds another number of values than the mesh that was read");
  with_type(type(array), [&](auto zero) {
    using Stored = decltype(zero);
    for (std::size_t k = 0; k < values.size(); ++k) {
      auto const value = Stored(values[k]);
      std::memcpy(after.data() + k * size, &value, size);
    }
  });
  if (after == before.bytes) return;
  bool const appended = storage(array) == Storage::appended;
  edits.push_back({before.begin, before.end, encoded(std::move(after), size, !appended || appended_base64_)});
}

std::string XmlFile::array_text(std::string const& name, int components, std::span<double const> values,
                                Tag const& like) const {
  bool const ascii = storage(like) == Storage::ascii;
  std::string out = "<DataArray type=\"Float64\" Name=\"" + name + "\" NumberOfComponents=\"" +
                    std::to_string(components) + "\" format=\"" + (ascii ? "ascii" : "binary") + "\">\n";
  if (ascii) {
    std::array<char, 32> digits{};
    for (std::size_t n = 0; n < values.size(); ++n) {
      out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), values[n]).ptr);
      out += (n + 1) % std::size_t(components) == 0 ? '\n' : ' ';
    }
  } else {
    std::string bytes(values.size_bytes(), '\0');
    std::memcpy(bytes.data(), values.data(), values.size_bytes());
    out += encoded(std::move(bytes), sizeof(double), true) + "\n";
  }
  return out + "</DataArray>\n";
}

std::string XmlFile::edited(std::vector<Edit> edits) const {
  // What grows among the appended bytes moves what is behind it.
  for (std::size_t const n = edits.size(); Attribute const* offset : offsets_) {
    Index value = 0;
    std::from_chars(offset->value.data(), offset->value.data() + offset->value.size(), value);
    std::ptrdiff_t grown = 0;
    for (std::size_t k = 0; k < n; ++k)
      if (edits[k].begin >= appended_begin_ && edits[k].begin < appended_begin_ + std::size_t(value))
        grown += std::ptrdiff_t(edits[k].by.size()) - std::ptrdiff_t(edits[k].end - edits[k].begin);
    if (grown != 0) edits.push_back({offset->begin, offset->end, std::to_string(value + grown)});
  }
  std::stable_sort(edits.begin(), edits.end(), [](Edit const& a, Edit const& b) { return a.begin < b.begin; });
  io::ReplacedText out(text_);
  for (Edit const& e : edits) out.replace(e.begin, e.end, e.by);
  return out.take();
}

}  // namespace gridmorph::vtk
