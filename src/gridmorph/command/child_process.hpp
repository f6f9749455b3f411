// Other programs, run to their end.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::cli {

/// Runs a program, looked for in PATH where its name has no slash, and hands on what it prints on standard output line
/// by line, without line feeds; standard error is ours. Its exit status, 128 + signal as shells count; nothing where it
/// cannot be started.
std::optional<int> run_child(std::vector<std::string> words, std::function<void(std::string_view line)> const& on_line);

}  // namespace gridmorph::cli
