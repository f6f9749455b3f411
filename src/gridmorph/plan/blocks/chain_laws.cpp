#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/plan/blocks/chain_laws.hpp>

#include <algorithm>

namespace gridmorph {
namespace {

constexpr std::array<char const*, 8> patch_kinds{"wall",     "inflow",     "outflow",    "symmetry",
                                                 "farfield", "degenerate", "connection", "other"};

bool is_kind(std::string const& word) {
  return word == "periodic" || std::find(patch_kinds.begin(), patch_kinds.end(), word) != patch_kinds.end();
}

std::vector<int> named_patches(Mesh const& mesh, std::string const& selector, std::string const& where) {
  std::string const at = where.empty() ? "" : where + ": ";
  Selection found;
  try {
    found = select(mesh, selector);
  } catch (MotionError const& e) {
    throw PlanError(at + e.what());
  }
  if (found.empty())
    throw PlanError(at + "a law is asked for between chains' ends '" + selector +
                    "', which is no kind of boundary and matches nothing; " + describe_selectable(mesh));
  std::vector<int> out = found.patches;
  for (int const i : found.interfaces) out.push_back(int(mesh.patches.size()) + i);
  return out;
}

}  // namespace

bool ChainLaws::End::fits(ChainEnd const& end) const {
  if (!kind.empty()) return kind == end_kind_name(end.kind);
  return std::any_of(end.patches.begin(), end.patches.end(),
                     [&](int p) { return std::binary_search(patches.begin(), patches.end(), p); });
}

ChainLaws::ChainLaws(Mesh const& mesh, VolumeOptions const& options) : linear_share_(options.linear_share) {
  usual_ = choice_of(options.law, options.own_law);
  for (LawOfEnds const& law : options.laws) {
    BetweenEnds& between = between_.emplace_back();
    for (int e = 0; e < 2; ++e) {
      if (is_kind(law.between[e]))
        between.end[e].kind = law.between[e];
      else
        between.end[e].patches = named_patches(mesh, law.between[e], law.where);
    }
    between.choice = choice_of(law.law, law.own);
  }
}

ChainLaws::Choice ChainLaws::choice_of(Law law, OwnLaw const& own) {
  if (law != Law::own) return {law, -1};
  LawTable const table = tabulate(own);
  OwnLaw const from_either{[&](double t) { return 0.5 * (own.weight(t) + 1 - own.weight(1 - t)); }, own.name};
  tables_.push_back({keep(table), keep(tabulate(from_either))});
  own_names_.push_back(own.name.empty() ? "of the user's own" : own.name);
  notes_.push_back("law " + own_names_.back() + " is kept as " + std::to_string(table.n_intervals) +
                   " cubics, which come within " + to_text(table.error, 2) + " of it");
  return {law, int(tables_.size()) - 1};
}

std::array<std::int32_t, 2> ChainLaws::keep(LawTable const& table) {
  auto const first = std::int32_t(knots_.size());
  knots_.insert(knots_.end(), table.knots.begin(), table.knots.end());
  return {first, table.n_intervals};
}

std::vector<char> ChainLaws::naming(int patch) const {
  std::vector<char> out;
  for (BetweenEnds const& between : between_)
    for (End const& end : between.end)
      out.push_back(std::binary_search(end.patches.begin(), end.patches.end(), patch) ? 1 : 0);
  return out;
}

ChainLaws::OfChain ChainLaws::of(Chain const& chain, std::optional<Law> given,
                                 std::vector<std::string> const& kind_order) const {
  // All others know their ends themselves; their chains stay as they were found.
  auto const starts = [](Choice const& choice, bool first, bool last) {
    return choice.law != Law::own || first == last ? From::either : first ? From::first : From::last;
  };
  if (given) return {{*given, -1}, From::either};
  for (auto const& [end, choice] : between_) {
    bool const first = end[0].fits(chain.first) && end[1].fits(chain.last);
    bool const last = end[0].fits(chain.last) && end[1].fits(chain.first);
    if (first || last) return {choice, starts(choice, first, last)};
  }
  int const first = kind_rank(chain.first.kind, kind_order), last = kind_rank(chain.last.kind, kind_order);
  return {usual_, starts(usual_, first <= last, last <= first)};
}

ChainLaw ChainLaws::along(OfChain const& of, std::array<bool, 2> const& near) const {
  using kernels::LineLaw;
  switch (of.choice.law) {
    case Law::linear: return LineLaw::linear;
    case Law::c1: return LineLaw::c1;
    case Law::c2: return LineLaw::c2;
    case Law::mixed: return {LineLaw::cubic, {linear_share_, linear_share_}};
    case Law::matched:
      if (near[0] && near[1]) return LineLaw::c1;
      if (!near[0] && !near[1]) return LineLaw::linear;
      return {LineLaw::cubic, {near[0] ? 0 : 1.5, near[1] ? 0 : 1.5}};
    case Law::own: {
      ChainLaw law = LineLaw::table;
      law.knots = tables_[of.choice.own][of.from == From::either ? 1 : 0];
      return law;
    }
  }
  return LineLaw::linear;
}

std::string ChainLaws::name(Choice const& choice) const {
  constexpr std::array<char const*, 5> names{"linear", "c1", "c2", "mixed", "matched"};
  return choice.law == Law::own ? own_names_[choice.own] : names.at(std::size_t(choice.law));
}

}  // namespace gridmorph
