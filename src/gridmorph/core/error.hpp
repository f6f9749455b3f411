// Errors of the library. Every message says what is wrong, where, which value was found, and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// Base of everything the library throws on bad input. Device code never throws.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The mesh is not usable: uncovered faces, unmatched interfaces, ranges out of bounds, ...
class MeshError : public Error {
 public:
  using Error::Error;
};

/// The motion rules are not usable: no such patch, rules in conflict, non-finite displacements, ...
class MotionError : public Error {
 public:
  using Error::Error;
};

/// The plan cannot be made: blocks that no chain reaches, near fields that meet, ...
class PlanError : public Error {
 public:
  using Error::Error;
};

/// A case file, displacement file or command line is not usable.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// A file cannot be opened, is damaged, or does not hold what it should.
class IoError : public Error {
 public:
  using Error::Error;
};

/// The machine failed: disk full, out of memory, permission denied on output.
class MachineError : public Error {
 public:
  using Error::Error;
};

/// Collects problems so that one pass over an input reports all of them.
class Problems {
 public:
  void add(std::string message) { messages_.push_back(std::move(message)); }
  [[nodiscard]] bool empty() const { return messages_.empty(); }
  [[nodiscard]] std::vector<std::string> const& messages() const { return messages_; }

  /// Throws one E that lists every problem, one per line; does nothing when there is none.
  template <class E>
  void throw_if_any() const {
    if (messages_.empty()) return;
    std::string text;
    for (auto const& m : messages_) {
      if (!text.empty()) text += '\n';
      text += m;
    }
    throw E(text);
  }

 private:
  std::vector<std::string> messages_;
};

}  // namespace gridmorph
