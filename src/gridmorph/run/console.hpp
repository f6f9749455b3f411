// Whom a run tells how far it is and what came out: a terminal, or whatever a program has in its place.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string_view>
#include <vector>

namespace gridmorph::cli {

class Console {
 public:
  Console() = default;
  Console(Console const&) = delete;
  Console& operator=(Console const&) = delete;
  virtual ~Console() = default;

  /// What the user asked to see (inspect, plan, quality), also when quiet.
  virtual void result(std::string_view text) = 0;
  /// The result for programs.
  virtual void document(nlohmann::json const& json) = 0;
  /// What happened along the way (morph, demo); not when quiet.
  virtual void say(std::string_view text) = 0;
  /// Results may not be what was meant; also when quiet.
  virtual void warn(std::string_view text) = 0;
  /// Why there is no result. A line that begins with a blank belongs to the one before it.
  virtual void error(std::string_view text) = 0;
  /// What long work is going on; called once per stage of expect().
  virtual void progress(std::string_view text) = 0;
  /// The same, where the caller knows how much of the work of expect() lies behind.
  virtual void progress(std::string_view text, double share) = 0;
  /// Work begins that calls progress(text) once per stage of the given costs; none: its end is not known.
  virtual void expect(std::vector<double> costs) = 0;

  [[nodiscard]] virtual bool quiet() const = 0;
  /// Whether documents are what is looked at, and nothing else.
  [[nodiscard]] virtual bool json() const = 0;
};

}  // namespace gridmorph::cli
