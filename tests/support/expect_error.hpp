// What an error says.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <string_view>

namespace gridmorph::test {

/// The message of the error that a call throws.
template <class Error, class Call>
std::string message_of(Call const& call) {
  try {
    call();
  } catch (Error const& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

inline void expect_all_in(std::string const& text, std::initializer_list<std::string_view> parts) {
  for (auto const part : parts) EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in:\n" << text;
}

}  // namespace gridmorph::test
