#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/plan_share.hpp>
#include <gridmorph/morph/share_contents.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/share.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace gridmorph {

struct PlanShare::State {
  ShareContents share;
};

Index PlanShare::n_nodes() const { return state_->share.chains.n_nodes; }
std::vector<Index> const& PlanShare::boundary_nodes() const { return state_->share.chains.boundary_nodes; }
std::vector<BoundaryPlace> const& PlanShare::boundary_places() const { return state_->share.places; }
std::vector<Vec3> const& PlanShare::boundary_displacement() const { return state_->share.displacement; }

Bytes PlanShare::to_bytes() const { return gridmorph::to_bytes(state_->share); }
PlanShare PlanShare::from_bytes(std::span<std::byte const> bytes) { return PlanAccess::of(share_from_bytes(bytes)); }

Plan const& PlanAccess::chains(PlanShare const& share) { return share.state_->share.chains; }
std::shared_ptr<SmoothingMap const> const& PlanAccess::smoothing(PlanShare const& share) {
  return share.state_->share.smoothing;
}
PlanShare PlanAccess::of(ShareContents&& contents) {
  return PlanShare(std::make_shared<PlanShare::State const>(PlanShare::State{std::move(contents)}));
}

namespace {

void require_whole_plan(MorphPlan const& plan, Mesh const& mesh) {
  std::string const who = "gridmorph::share: ";
  if (PlanAccess::chains(plan) == nullptr)
    throw ConfigError(who + "a plan of elements has no shares yet; plans of blocks do");
  if (mesh.n_nodes() != plan.n_nodes() || mesh.coordinates.size() != plan.n_nodes())
    throw ConfigError(who + "the plan is of a mesh of " + std::to_string(plan.n_nodes()) + " nodes; this one has " +
                      std::to_string(mesh.n_nodes()) + ", and coordinates of " +
                      std::to_string(mesh.coordinates.size()));
}

ShareContents contents_of(HostInstance const& host, MorphPlan const& plan, std::vector<BoundaryPlace> places,
                          Mesh const& mesh, std::span<NodeBox const> boxes) {
  ShareContents out{
      share_of(host, *PlanAccess::chains(plan), mesh, boxes), std::move(places), plan.boundary_displacement(), {}};
  if (plan.smoothing()) out.smoothing = std::make_shared<SmoothingMap const>(share_of(*plan.smoothing(), mesh, boxes));
  return out;
}

/// Ranks whose shares are there at once.
constexpr int ranks_per_round = 16;

}  // namespace

PlanShare share(HostInstance const& host, MorphPlan const& plan, Mesh const& mesh, std::span<NodeBox const> boxes) {
  require_whole_plan(plan, mesh);
  return PlanAccess::of(contents_of(host, plan, plan.boundary_places(), mesh, boxes));
}

PlanShare share_out(Ranks const& ranks, HostInstance const& host, MorphPlan const* plan, Mesh const* mesh,
                    std::span<NodeBox const> boxes) {
  std::vector<Bytes> const asked = ranks.gather(std::as_bytes(boxes));
  bool const has_plan = ranks.rank() == 0;
  std::vector<BoundaryPlace> places;
  together(ranks, [&] {
    if (!has_plan) return;
    if (plan == nullptr || mesh == nullptr)
      throw ConfigError("gridmorph::share_out: rank 0 has to have the plan and its mesh; they are null there");
    require_whole_plan(*plan, *mesh);
    places = plan->boundary_places();
  });
  Bytes own;
  for (int first = 0; first < ranks.size(); first += ranks_per_round) {
    std::vector<Packet> out = together(ranks, [&] {
      std::vector<Packet> packets;
      for (int r = first; has_plan && r < std::min(first + ranks_per_round, ranks.size()); ++r)
        packets.push_back(
            {r, to_bytes(contents_of(host, *plan, places, *mesh, from_bytes<NodeBox>(asked[std::size_t(r)])))});
      return packets;
    });
    for (Packet& packet : ranks.send(std::move(out))) own = std::move(packet.bytes);
  }
  return together(ranks, [&] { return PlanShare::from_bytes(own); });
}

}  // namespace gridmorph
