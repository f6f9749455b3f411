#include <gridmorph/core/error.hpp>
#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/gmsh/gmsh_file.hpp>
#include <gridmorph/io/printable.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/real_text.hpp>

#include <algorithm>
#include <charconv>

namespace gridmorph::gmsh {

Text::Text(std::string const& path) : path_(path), text_(io::read_file(path)) { read_format(); }

void Text::fail_at(std::size_t at, std::string const& what) const {
  at = std::min(at, text_.size());
  std::string const place =
      format_.binary ? ", byte " + std::to_string(at)
                     : ":" + std::to_string(1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n'));
  throw IoError(path_ + place + ": " + what);
}

void Text::ends(char const* what) const {
  fail("the file ends where " + std::string(what) + " has to follow; get a whole copy of it");
}

void Text::skip_blanks() {
  while (at_ < text_.size() && io::is_blank(text_[at_])) ++at_;
}

std::string_view Text::word(char const* what) {
  skip_blanks();
  std::size_t const begin = at_;
  while (at_ < text_.size() && !io::is_blank(text_[at_])) ++at_;
  if (begin == at_) ends(what);
  return std::string_view(text_).substr(begin, at_ - begin);
}

bool Text::passes(std::string_view word) {
  skip_blanks();
  if (text_.compare(at_, word.size(), word) != 0) return false;
  at_ += word.size();
  return true;
}

std::int64_t Text::integer_word(char const* what) {
  auto const found = word(what);
  std::int64_t value = 0;
  auto const [end, failure] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (failure != std::errc() || end != found.data() + found.size())
    fail_at(at_ - found.size(), "expected " + std::string(what) + ", found '" + io::printable(found) + "'");
  return value;
}

double Text::real(char const* what) {
  if (format_.binary) return raw<double>(what);
  auto const found = word(what);
  auto const value = io::real_of(found);
  if (!value) fail_at(at_ - found.size(), "expected " + std::string(what) + ", found '" + io::printable(found) + "'");
  return *value;
}

void Text::skip_real(char const* what) {
  if (format_.binary)
    static_cast<void>(raw<double>(what));
  else
    static_cast<void>(word(what));
}

std::string Text::quoted(char const* what) {
  skip_blanks();
  if (at_ >= text_.size()) ends(what);
  if (text_[at_] != '"') return std::string(word(what));
  auto const end = text_.find('"', at_ + 1);
  if (end == std::string::npos) fail("a name that begins here does not end");
  std::string out = text_.substr(at_ + 1, end - at_ - 1);
  at_ = end + 1;
  return out;
}

Index Text::checked(std::int64_t n, char const* what, std::size_t least_bytes) const {
  if (n < 0 || std::uint64_t(n) > (text_.size() - at_) / least_bytes)
    fail(std::string(what) + " is " + std::to_string(n) +
         ", which is more than the rest of the file can hold, or less than nothing; get a whole copy of it");
  return n;
}

Index Text::count(char const* what, std::size_t least_bytes, bool wide) {
  return checked(wide ? number64(what) : number32(what), what, least_bytes);
}

void Text::begin_raw() {
  if (!format_.binary) return;
  while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\r')) ++at_;
  if (at_ < text_.size() && text_[at_] == '\n') ++at_;
}

std::string Text::section() {
  skip_blanks();
  if (at_ >= text_.size()) return {};
  auto const found = word("a section");
  if (found.size() < 2 || found.front() != '$' || found.starts_with("$End"))
    fail_at(at_ - found.size(), "expected the beginning of a section ($Nodes, ...), found '" + io::printable(found) +
                                    "'; there may be more numbers than the section before it says");
  return std::string(found.substr(1));
}

void Text::end_section(std::string const& name) {
  auto const found = word(("$End" + name).c_str());
  if (found != "$End" + name)
    fail_at(at_ - found.size(), "expected $End" + name + ", found '" + io::printable(found) +
                                    "'; the section holds more than its counts say, or the file is damaged");
}

void Text::skip_section(std::string const& name) {
  auto const end = text_.find("$End" + name, at_);
  if (end == std::string::npos) fail("section $" + name + " does not end; get a whole copy of the file");
  at_ = end;
  end_section(name);
}

void Text::read_format() {
  // Gmsh passes over what stands before.
  while (true) {
    std::string const name = section();
    if (name.empty()) fail("has no $MeshFormat; it is no mesh of Gmsh");
    if (name == "NOD" || name == "NOE")
      fail("is a mesh of Gmsh in format 1; write it again: gmsh -save FILE -format msh41 -o mesh.msh");
    if (name == "MeshFormat") break;
    skip_section(name);
  }
  std::string const version(word("a version"));
  format_.version = version == "2.2" ? 22 : version == "4.1" ? 41 : version == "4" || version == "4.0" ? 40 : 0;
  std::int64_t const binary = integer_word("0 for text or 1 for binary");
  std::int64_t const size = integer_word("the size of numbers");
  if (format_.version == 0 || (format_.version == 40 && binary != 0))
    fail("is MSH " + version + (binary != 0 ? ", binary" : "") +
         "; read are 2.2 and 4.1, text and binary, and 4.0 as text. Write it again: gmsh -save FILE -format msh41 -o "
         "mesh.msh");
  if (binary != 0 && binary != 1) fail("the file type is " + std::to_string(binary) + "; 0 is text and 1 binary");
  if (size != 8)
    fail("numbers are of " + std::to_string(size) +
         " bytes; 8 are read. Write it again: gmsh -save FILE -format msh41 -o mesh.msh");
  if (binary == 1) {
    format_.binary = true;
    begin_raw();
    auto const one = raw<std::int32_t>("the number 1");
    constexpr std::int32_t swapped_one = 1 << 24;
    format_.swapped = one == swapped_one;
    if (one != 1 && one != swapped_one)
      fail("the number that tells the byte order is " + std::to_string(one) + " instead of 1; the file is damaged");
  }
  end_section("MeshFormat");
}

}  // namespace gridmorph::gmsh
