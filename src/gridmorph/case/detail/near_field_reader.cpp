#include <gridmorph/case/detail/case_parts.hpp>
#include <gridmorph/case/detail/law_reader.hpp>

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

/// A mesh of the user's has a wrap of its own.
void read_background_file(TableReader& root, TableReader& background, CaseFile& out) {
  auto const file = background.input("file");
  auto const wrap = background.strings("wrap"), outer = background.strings("outer");
  if (!file) {
    for (auto const* key : {"wrap", "outer"})
      if (background.has(key))
        background.problem(key, "names patches of a background mesh; add file = \"background.cgns\" or remove it");
    return;
  }
  BackgroundFile& own = out.background.emplace();
  own.path = *file;
  if (wrap) own.wrap = *wrap;
  if (outer) own.outer = *outer;
  std::string const why = "is for a background mesh that is made here, and this one is read from a file; remove it";
  if (background.has("cells")) background.problem("cells", why);
  if (auto near = root.table("near_field"))
    for (auto const* key : {"offset", "wrap", "resolution"})
      if (near->has(key)) near->problem(key, why);
}

}  // namespace

void read_near_field(TableReader& root, std::map<std::string, double> const& constants, CaseFile& case_file) {
  ElementOptions& out = case_file.plan.elements;
  bool is_wrapped = false;  // by what the case file says of the wrap and the background mesh around it
  if (auto near = root.table("near_field")) {
    out.walls = near->strings("walls").value_or(std::vector<std::string>{});
    if (auto const offset = near->number("offset")) {
      out.offset = *offset;
      if (*offset <= 0)
        near->problem("offset", fmt::format("must be a positive length, found {}; remove it for the default", *offset));
    }
    if (auto const method = near->choice("method", {"automatic", "lattice", "layers", "least-squares"}))
      out.method = NearFieldMethod(*method);
    if (auto const weight = near->choice("weights", {"uniform", "inverse-distance", "quality", "curvature"}))
      out.weight = LayerWeight(*weight);
    if (auto const wrap = near->choice("wrap", {"lattice", "tube"})) out.tube = *wrap == 1;
    read_count(*near, "resolution", 1, 200, out.resolution);
    is_wrapped = near->has("wrap") || near->has("resolution");
    near->finish();
  }
  if (auto background = root.table("background")) {
    read_count(*background, "cells", 1, 32, out.cells);
    read_background_file(root, *background, case_file);
    VolumeOptions& volume = case_file.plan.volume;
    read_law(*background, {"linear", "c1", "c2", "formula"}, constants, volume.law, volume.own_law);
    background->finish();
    is_wrapped = true;
  }
  if (is_wrapped && out.method == NearFieldMethod::automatic) out.method = NearFieldMethod::lattice;
}

}  // namespace gridmorph::casefile
