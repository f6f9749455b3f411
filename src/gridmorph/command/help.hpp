// What --help prints around the options: an example first, the docs last.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace gridmorph::cli {

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  [[nodiscard]] std::string make_description(CLI::App const* app) const override;
  [[nodiscard]] std::string make_footer(CLI::App const* app) const override;
};

}  // namespace gridmorph::cli
