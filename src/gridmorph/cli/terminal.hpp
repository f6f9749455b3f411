// Where the program's words go: results to standard output, everything else to standard error.
#pragma once

#include <string>
#include <string_view>

namespace gridmorph::cli {

class Terminal {
 public:
  explicit Terminal(bool quiet);
  ~Terminal();
  Terminal(Terminal const&) = delete;
  Terminal& operator=(Terminal const&) = delete;

  /// What the user asked to see (inspect, plan, quality): to standard output, also when quiet.
  void result(std::string_view text);
  /// What happened along the way (morph, demo): to standard output unless quiet.
  void say(std::string_view text);
  /// "gridmorph: warning: ..." to standard error, also when quiet: results may not be what was meant.
  void warn(std::string_view text);
  /// "gridmorph: error: ..." to standard error; every line that does not begin with a blank gets the prefix.
  void error(std::string_view text);
  /// Shows what long work is going on, in one line that the next one replaces; only when standard error is a terminal.
  void progress(std::string_view text);

  [[nodiscard]] bool quiet() const { return quiet_; }

  /// Throws MachineError when standard output could not be written, unless its reader has gone (a closed pipe).
  void finish();

 private:
  void to_standard_output(std::string_view text);
  void clear_progress();

  bool quiet_;
  bool interactive_;
  bool shown_ = false;
  int error_ = 0;
};

}  // namespace gridmorph::cli
