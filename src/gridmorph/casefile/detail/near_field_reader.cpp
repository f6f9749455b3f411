#include <gridmorph/casefile/detail/near_field_reader.hpp>

#include <fmt/format.h>

#include <string>

namespace gridmorph::casefile {

namespace {

void read_count(TableReader& table, std::string const& key, int low, int high, int& value) {
  auto const given = table.integer(key);
  if (!given) return;
  value = *given;
  if (value < low || value > high) table.problem(key, fmt::format("must be {} to {}, found {}", low, high, value));
}

}  // namespace

void read_near_field(TableReader& root, UnstructuredOptions& out) {
  if (auto near = root.table("near_field")) {
    out.walls = near->strings("walls").value_or(std::vector<std::string>{});
    if (auto const offset = near->number("offset")) {
      out.offset = *offset;
      if (*offset <= 0)
        near->problem("offset", fmt::format("must be a positive length, found {}; remove it for the default", *offset));
    }
    if (auto const weight = near->choice("weights", {"uniform", "inverse-distance", "quality", "curvature"}))
      out.weight = LayerWeight(*weight);
    if (auto const wrap = near->choice("wrap", {"lattice", "tube"})) out.tube = *wrap == 1;
    read_count(*near, "resolution", 1, 200, out.resolution);
    near->finish();
  }
  if (auto background = root.table("background")) {
    read_count(*background, "cells", 1, 32, out.cells);
    if (auto const law = background->choice("law", {"linear", "c1", "c2"})) out.law = Law(*law);
    background->finish();
  }
}

}  // namespace gridmorph::casefile
