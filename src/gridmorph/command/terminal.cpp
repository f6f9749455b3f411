#include <gridmorph/command/terminal.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/report/json_text.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include <unistd.h>

namespace gridmorph::cli {

namespace {

/// As a terminal may see it: what could set it (escape sequences, the window's title) or write over lines comes from
/// names in files, and is shown as '?'.
std::string harmless(std::string_view text) {
  std::string out(text);
  for (std::size_t n = 0; n < out.size(); ++n) {
    auto const c = static_cast<unsigned char>(out[n]);
    bool const control = (c < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
    // U+0080 ... U+009F, which are control characters too.
    bool const second_set = c == 0xc2 && n + 1 < out.size() && (static_cast<unsigned char>(out[n + 1]) & 0xe0) == 0x80;
    if (control) out[n] = '?';
    if (second_set) out.replace(n, 2, "?");
  }
  return out;
}

void prefixed(std::string_view kind, std::string_view raw) {
  // A message is never empty: a status without a word says nothing to anybody.
  std::string const shown = raw.empty() ? std::string("no more is known") : harmless(raw);
  std::string_view text = shown;
  std::string out;
  while (!text.empty()) {
    std::size_t const end = text.find('\n');
    std::string_view const line = text.substr(0, end);
    if (!line.empty() && line.front() != ' ') out.append("gridmorph: ").append(kind).append(": ");
    out.append(line).push_back('\n');
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  std::fwrite(out.data(), 1, out.size(), stderr);
}

}  // namespace

constexpr double seconds_between_lines = 10;

Terminal::Terminal(bool quiet, bool json)
    : pace_(seconds_between_lines), quiet_(quiet), json_(json), interactive_(!quiet && isatty(STDERR_FILENO) != 0) {}
Terminal::~Terminal() { clear_progress(); }

void Terminal::to_standard_output(std::string_view text) {
  clear_progress();
  if (error_ != 0 || text.empty()) return;
  errno = 0;
  bool const ended = text.back() == '\n';
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || (!ended && std::fputc('\n', stdout) == EOF) ||
      std::fflush(stdout) != 0)
    error_ = errno != 0 ? errno : EIO;
}

void Terminal::result(std::string_view text) { to_standard_output(harmless(text)); }

void Terminal::say(std::string_view text) {
  if (!quiet_ && !json_) to_standard_output(harmless(text));
}

void Terminal::document(nlohmann::json const& json) {
  if (json_) documents_.push_back(json);
}

std::vector<nlohmann::json> Terminal::take_documents() { return std::exchange(documents_, {}); }

void Terminal::warn(std::string_view text) {
  clear_progress();
  prefixed("warning", text);
}

void Terminal::error(std::string_view text) {
  clear_progress();
  prefixed("error", text);
}

void Terminal::expect(std::vector<double> costs) {
  stages_.expect(std::move(costs));
  begin_ = std::chrono::steady_clock::now();
  pace_ = LogPace(seconds_between_lines);
}

void Terminal::progress(std::string_view text) { show(text, stages_.advance()); }

void Terminal::progress(std::string_view text, double share) { show(text, share); }

void Terminal::show(std::string_view text, std::optional<double> share) {
  if (quiet_) return;
  double const elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (!interactive_ && !pace_.due(elapsed)) return;
  std::string const line = harmless(progress_text(text, share, elapsed));
  clear_progress();
  std::fprintf(stderr, interactive_ ? "%s ..." : "gridmorph: %s ...\n", line.c_str());
  std::fflush(stderr);
  shown_ = interactive_;
}

void Terminal::clear_progress() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

void Terminal::finish() {
  for (auto const& json : take_documents()) to_standard_output(json_text(json));
  clear_progress();
  if (error_ == 0 && std::fflush(stdout) != 0) error_ = errno;
  if (error_ != 0 && error_ != EPIPE)
    throw MachineError(std::string("standard output cannot be written: ") + std::strerror(error_));
}

}  // namespace gridmorph::cli
