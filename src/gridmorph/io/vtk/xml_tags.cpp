#include <gridmorph/core/error.hpp>
#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/vtk/xml_file.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace gridmorph::vtk {

namespace {

constexpr int deepest = 64;

class Parser {
 public:
  Parser(std::string const& path, std::string_view text) : path_(path), text_(text) {}

  Tag run() {
    if (!next_tag() || text_[at_ + 1] == '/') fail("is no XML file: it holds no tag");
    return tag(0);
  }

 private:
  [[noreturn]] void fail(std::string const& what) const { fail_at(path_, text_, at_, what); }
  [[nodiscard]] bool follows(std::string_view part) const { return text_.substr(at_, part.size()) == part; }

  void skip_to(std::string_view end, char const* what) {
    auto const found = text_.find(end, at_);
    if (found == std::string_view::npos)
      fail(std::string(what) + " that begins here does not end; get a whole copy of the file");
    at_ = found + end.size();
  }

  /// Goes to the '<' of the next tag that is one; false at the end of the file.
  bool next_tag() {
    while (true) {
      at_ = std::min(text_.find('<', at_), text_.size());
      if (at_ + 1 >= text_.size()) return false;
      if (follows("<!--"))
        skip_to("-->", "a comment");
      else if (follows("<![CDATA["))
        fail("CDATA is not read; write the file with VTK");
      else if (text_[at_ + 1] == '?' || text_[at_ + 1] == '!')
        skip_to(">", "a declaration");
      else
        return true;
    }
  }

  void blanks() {
    while (at_ < text_.size() && io::is_blank(text_[at_])) ++at_;
    if (at_ >= text_.size()) fail("the file ends inside a tag; get a whole copy of it");
  }

  std::string name() {
    std::size_t const begin = at_;
    while (at_ < text_.size() && !io::is_blank(text_[at_]) && text_[at_] != '>' && text_[at_] != '/' &&
           text_[at_] != '=' && text_[at_] != '<')
      ++at_;
    if (begin == at_) fail("a name is missing in a tag");
    return std::string(text_.substr(begin, at_ - begin));
  }

  static std::string plain(std::string_view text) {
    static constexpr std::array<std::pair<std::string_view, char>, 5> entities{
        {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};
    std::string out;
    for (std::size_t n = 0; n < text.size();) {
      auto const found = std::find_if(entities.begin(), entities.end(),
                                      [&](auto const& e) { return text.substr(n).starts_with(e.first); });
      out += found == entities.end() ? text[n] : found->second;
      n += found == entities.end() ? 1 : found->first.size();
    }
    return out;
  }

  Tag tag(int depth) {
    if (depth > deepest) fail("tags are more than " + std::to_string(deepest) + " deep");
    Tag out;
    out.begin = at_++;
    out.name = name();
    while (true) {
      blanks();
      if (text_[at_] == '>' || text_[at_] == '/') break;
      Attribute a;
      a.name = name();
      blanks();
      if (text_[at_++] != '=') fail("'=' has to follow the attribute '" + a.name + "'");
      blanks();
      char const quote = text_[at_++];
      auto const end = quote == '"' || quote == '\'' ? text_.find(quote, at_) : std::string_view::npos;
      if (end == std::string_view::npos) fail("the value of the attribute '" + a.name + "' has to stand in quotes");
      a.begin = at_;
      a.end = end;
      a.value = plain(text_.substr(at_, end - at_));
      if (a.value.find('\0') != std::string::npos)
        fail("the value of the attribute '" + a.name +
             "' holds a zero byte, which XML does not have; write the file again");
      at_ = end + 1;
      out.attributes.push_back(std::move(a));
    }
    out.closed = text_[at_] == '/';
    if (out.closed && (++at_ >= text_.size() || text_[at_] != '>')) fail("'>' has to follow '/' in a tag");
    out.inside = out.inside_end = out.end = ++at_;
    if (!out.closed) content(out, depth);
    return out;
  }

  void content(Tag& out, int depth) {
    std::string const end = "</" + out.name;
    if (out.name == "AppendedData") {
      auto const found = text_.rfind(end);
      if (found == std::string_view::npos || found < at_)
        fail("AppendedData does not end; get a whole copy of the file");
      at_ = found;
    }
    while (true) {
      if (!next_tag()) {
        at_ = out.begin;
        fail("<" + out.name + "> that begins here does not end; get a whole copy of the file");
      }
      if (text_[at_ + 1] != '/') {
        out.children.push_back(tag(depth + 1));
        continue;
      }
      if (!follows(end) || at_ + end.size() >= text_.size() ||
          (text_[at_ + end.size()] != '>' && !io::is_blank(text_[at_ + end.size()])))
        fail("</" + out.name + "> is expected here");
      out.inside_end = at_;
      skip_to(">", "a tag");
      out.end = at_;
      return;
    }
  }

  std::string const& path_;
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Attribute const* Tag::attribute(std::string_view wanted) const {
  auto const found =
      std::find_if(attributes.begin(), attributes.end(), [&](Attribute const& a) { return a.name == wanted; });
  return found == attributes.end() ? nullptr : &*found;
}

std::string_view Tag::operator[](std::string_view wanted) const {
  auto const* found = attribute(wanted);
  return found == nullptr ? std::string_view() : std::string_view(found->value);
}

Tag const* Tag::child(std::string_view wanted) const {
  auto const found = std::find_if(children.begin(), children.end(), [&](Tag const& t) { return t.name == wanted; });
  return found == children.end() ? nullptr : &*found;
}

Tag parse_tags(std::string const& path, std::string_view text) { return Parser(path, text).run(); }

std::string escaped(std::string_view text) {
  std::string out;
  for (char const c : text) out += c == '"' ? "&quot;" : c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

void fail_at(std::string const& path, std::string_view text, std::size_t at, std::string const& what) {
  auto const line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(std::min(at, text.size())), '\n');
  throw IoError(path + ":" + std::to_string(line) + ": " + what);
}

}  // namespace gridmorph::vtk
