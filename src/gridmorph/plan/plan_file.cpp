#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/detail/archive.hpp>
#include <gridmorph/plan/detail/check_plan.hpp>
#include <gridmorph/plan/detail/hash64.hpp>
#include <gridmorph/plan/detail/plan_fields.hpp>
#include <gridmorph/plan/detail/whole_file.hpp>
#include <gridmorph/plan/plan_file.hpp>

#include <span>
#include <string>
#include <string_view>

namespace gridmorph {

namespace detail {
GRIDMORPH_DETAIL_FIELDS(PlanKey, format, structure, coordinates, rules, options, n_nodes)
}  // namespace detail

namespace {

/// Line ends in it show a transfer as text.
constexpr std::string_view magic = "GMPLAN\r\n";

/// Everything that differs, in words; empty when nothing does.
std::string differences(PlanKey const& made_for, PlanKey const& key) {
  std::string text;
  auto const differs = [&](bool yes, char const* what) {
    if (yes) text += (text.empty() ? "" : ", ") + std::string(what);
  };
  differs(made_for.structure != key.structure || made_for.n_nodes != key.n_nodes,
          "the zones, patches or interfaces of the mesh (as they are before prepare() completes its patches)");
  differs(made_for.coordinates != key.coordinates, "the coordinates of the mesh");
  differs(made_for.rules != key.rules, "the motion rules");
  differs(made_for.options != key.options, "the plan options");
  return text;
}

}  // namespace

void save_plan(std::filesystem::path const& path, Plan const& plan, PlanKey const& key) {
  if (plan.n_nodes != key.n_nodes || key.format != plan_format_version)
    throw PlanError(path.string() + ": not written: the plan is for " + std::to_string(plan.n_nodes) +
                    " nodes and the key for " + std::to_string(key.n_nodes) + " (plan format " +
                    std::to_string(key.format) + "); take plan_key() of the mesh that was planned");
  detail::ByteWriter bytes;
  bytes.raw(std::as_bytes(std::span(magic)));
  pass(bytes, key);
  pass(bytes, plan);
  bytes.number(detail::hash64(bytes.bytes()));
  detail::write_whole(path, bytes.bytes());
}

Plan load_plan(std::filesystem::path const& path, PlanKey const& key) {
  std::vector<std::byte> const file = detail::read_whole(path, magic);
  std::span<std::byte const> bytes(file);
  Plan plan;
  PlanKey made_for;
  try {
    std::uint64_t checksum = 0;
    if (bytes.size() < magic.size() + sizeof made_for.format + sizeof checksum)
      throw detail::Damaged("it ends too early");
    detail::ByteReader(bytes.subspan(magic.size())).number(made_for.format);
    if (made_for.format != plan_format_version)
      throw PlanError(path.string() + ": has plan format " + std::to_string(made_for.format) +
                      ", this version of gridmorph has " + std::to_string(plan_format_version) + "; plan again");
    std::size_t const end = bytes.size() - sizeof checksum;
    detail::ByteReader(bytes.subspan(end)).number(checksum);
    if (checksum != detail::hash64(bytes.first(end))) throw detail::Damaged("its checksum is wrong");

    detail::ByteReader in(bytes.first(end).subspan(magic.size()));
    pass(in, made_for);
    if (std::string const what = differences(made_for, key); !what.empty())
      throw PlanError(path.string() + ": was made for something else; changed since: " + what +
                      ". Plan again and save the new plan");
    pass(in, plan);
    if (in.left() > 0) throw detail::Damaged(std::to_string(in.left()) + " bytes too many");
    detail::check_plan(plan, key.n_nodes);
  } catch (detail::Damaged const& e) {
    throw IoError(path.string() + ": is damaged: " + e.what() + "; delete it and plan again");
  }
  return plan;
}

}  // namespace gridmorph
