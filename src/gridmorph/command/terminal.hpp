// Where the program's words go: results to standard output, everything else to standard error.
#pragma once

#include <gridmorph/report/progress_text.hpp>
#include <gridmorph/run/console.hpp>

#include <nlohmann/json.hpp>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::cli {

class Terminal final : public Console {
 public:
  /// json: documents go to standard output, and nothing else.
  explicit Terminal(bool quiet, bool json = false);
  ~Terminal() override;

  /// What the user asked to see (inspect, plan, quality): to standard output, also when quiet.
  void result(std::string_view text) override;
  /// The result for programs: printed by finish() with --json, not looked at without.
  void document(nlohmann::json const& json) override;
  /// The documents so far, for a command that makes one of several.
  [[nodiscard]] std::vector<nlohmann::json> take_documents();
  /// What happened along the way (morph, demo): to standard output unless quiet, and not with --json.
  void say(std::string_view text) override;
  /// "gridmorph: warning: ..." to standard error, also when quiet: results may not be what was meant.
  void warn(std::string_view text) override;
  /// "gridmorph: error: ..." to standard error; every line that does not begin with a blank gets the prefix.
  void error(std::string_view text) override;
  /// Shows what long work is going on. Where standard error is a terminal: in one line that the next one replaces, with
  /// percent and time left where the end is known. Otherwise a line when the last one is some time ago. Nothing when
  /// quiet.
  void progress(std::string_view text) override;
  /// The same, where the caller knows how much of the work of expect() lies behind.
  void progress(std::string_view text, double share) override;
  /// Work begins that calls progress(text) once per stage of the given costs; none: its end is not known.
  void expect(std::vector<double> costs) override;

  [[nodiscard]] bool quiet() const override { return quiet_; }
  [[nodiscard]] bool json() const override { return json_; }

  /// Throws MachineError when standard output could not be written, unless its reader has gone (a closed pipe).
  void finish();

 private:
  void to_standard_output(std::string_view text);
  void clear_progress();
  void show(std::string_view text, std::optional<double> share);

  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  StagedProgress stages_;
  LogPace pace_;
  bool quiet_;
  bool json_;
  bool interactive_;
  bool shown_ = false;
  int error_ = 0;
  std::vector<nlohmann::json> documents_;
};

}  // namespace gridmorph::cli
