// Helpers of the casefile tests: read text, and expect messages.
#pragma once

#include "support/temporary_folder.hpp"

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace gridmorph::test {

using test::TemporaryFolder;

/// The lines of the error that `action` throws; empty when it throws nothing.
template <class E = ConfigError, class Action>
std::vector<std::string> error_lines(Action const& action) {
  try {
    action();
  } catch (E const& e) {
    std::vector<std::string> lines{""};
    for (char const c : std::string(e.what())) {
      if (c == '\n')
        lines.emplace_back();
      else
        lines.back() += c;
    }
    return lines;
  }
  return {};
}

inline std::vector<std::string> problems_of(std::string const& text) {
  return error_lines([&] { (void)parse_case_file(text, "case.toml"); });
}

/// Whether one of the lines begins with `where` and contains all of `words`.
inline ::testing::AssertionResult reported(std::vector<std::string> const& lines, std::string const& where,
                                           std::vector<std::string> const& words) {
  for (auto const& line : lines)
    if (line.rfind(where, 0) == 0 && std::all_of(words.begin(), words.end(), [&](std::string const& w) {
          return line.find(w) != std::string::npos;
        }))
      return ::testing::AssertionSuccess();
  std::string all;
  for (auto const& line : lines) all += "\n  " + line;
  return ::testing::AssertionFailure() << "no line '" << where << " ...' among:" << (all.empty() ? " nothing" : all);
}

inline Vec3 displacement_of(Rule const& rule, Vec3 const& point) {
  std::array<Vec3, 1> const points{point};
  std::array<Vec3, 1> out{Vec3{-1, -1, -1}};
  std::get<FunctionRule>(rule).function(points, out);
  return out[0];
}

/// A case file with one rule for 'blade' and an x axis; `lines` begin on line 7.
inline std::string case_with_rule(std::string const& lines) {
  return "[mesh]\ninput = \"in.cgns\"\noutput = \"out.cgns\"\naxis = { direction = [1, 0, 0] }\n"
         "[[motion]]\npatches = [\"blade\"]\n" +
         lines;
}

inline Rule rule_of(std::string const& lines) {
  return parse_case_file(case_with_rule(lines), "case.toml").motion.rules.at(0).rule;
}

#define EXPECT_VEC3_NEAR(a, b, tolerance)    \
  do {                                       \
    ::gridmorph::Vec3 const left = (a);      \
    ::gridmorph::Vec3 const right = (b);     \
    EXPECT_NEAR(left.x, right.x, tolerance); \
    EXPECT_NEAR(left.y, right.y, tolerance); \
    EXPECT_NEAR(left.z, right.z, tolerance); \
  } while (false)

}  // namespace gridmorph::test
