// The motion that a part of a mesh has in common (kernels/common_motion.hpp): tables, and what both kinds of mesh do
// with them.
#pragma once

#include <gridmorph/kernels/common_motion.hpp>
#include <gridmorph/kernels/common_rest.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/common_motion.hpp>

#include <algorithm>
#include <string>

namespace gridmorph::stages {

template <class Exec>
struct CommonMotionTables {
  using Memory = typename Exec::memory_space;

  kernels::CommonFrame frame;
  List<Exec, Vec3> position;
  List<Exec, double> weight;
  List<Exec, kernels::CommonProjection> projection;
  List<Exec, Vec3> beyond;
  List<Exec, kernels::CommonMap> partial;
  List<Exec, kernels::CommonMove> move;  ///< of each field, and of gradients
  bool pulls;                            ///< whether what is left is seen from the moved mesh

  /// n_chunks: of nodes that gradients are summed over, where the transpose is asked for. moves: room for `move`; none:
  /// it is made.
  CommonMotionTables(Exec const& exec, CommonMotion const& plan, int n_fields, Index n_chunks, bool pull,
                     List<Exec, kernels::CommonMove> const& moves = {})
      : frame(plan.frame),
        position(upload(exec, plan.position, name("position"))),
        weight(upload(exec, plan.weight, name("weight"))),
        projection(upload(exec, std::vector<kernels::CommonProjection>{plan.projection}, name("projection"))),
        beyond(room_for<Vec3>(exec, plan.position.size(), name("beyond"))),
        partial(room_for<kernels::CommonMap>(
            exec, std::size_t(kernels::common_chunks(Index(plan.position.size())) + n_chunks), name("partial"))),
        move(moves.extent(0) > 0 ? moves
                                 : room_for<kernels::CommonMove>(exec, std::size_t(n_fields) + 1, name("move"))),
        pulls(pull) {
    compat::fence(exec, "gridmorph::CommonMotion (host tables may go)");
  }

  [[nodiscard]] kernels::CommonMove const* of(int f) const { return move.data() + f; }

  /// of(to): the fit to what the boundary nodes are given.
  void fit(Exec const& exec, Vec3 const* given, int to) const {
    kernels::CommonMoments<Memory> const moments{frame, position, weight, given, nullptr, nullptr, 1, partial.data()};
    kernels::launch("gridmorph::common::moments", exec, moments);
    sum<false>(exec, moments.size(), pulls, to);
    // Once more, for what rounding has left of large displacements.
    kernels::launch("gridmorph::common::beyond", exec,
                    kernels::RestBeyondCommon<Memory>{frame, position, of(to), given, beyond.data()});
    kernels::CommonMoments<Memory> const more{frame,   position, weight, beyond.data(),
                                              nullptr, nullptr,  1,      partial.data()};
    kernels::launch("gridmorph::common::moments", exec, more);
    sum<true>(exec, more.size(), pulls, to);
  }
  void take(Exec const& exec, Vec3 const* given, int f, List<Exec, Vec3> const& rest) const {
    kernels::launch("gridmorph::common::take", exec,
                    kernels::TakeCommonMotion<Memory>{frame, position, of(f), given, rest.data()});
  }
  void take_rate(Exec const& exec, Vec3 const* given, int f, int r, Vec3 const* rest,
                 List<Exec, Vec3> const& rest_rate) const {
    kernels::launch("gridmorph::common::take_rate", exec,
                    kernels::TakeCommonRate<Memory>{frame, position, of(f), of(r), given, rest, rest_rate.data()});
  }
  /// Adds it to the first n nodes.
  void add(Exec const& exec, Baseline const& x, int f, Index n, Vec3* u) const {
    kernels::launch("gridmorph::common::add", exec, 0, n, kernels::AddCommonMotion{frame, x, of(f), u});
  }
  void add_rate(Exec const& exec, Baseline const& x, int f, int r, Index n, Vec3 const* u, Vec3* v) const {
    kernels::launch("gridmorph::common::add_rate", exec, 0, n, kernels::AddCommonRate{frame, x, of(f), of(r), u, v});
  }

  /// Gradients g at nodes, before motions are added at f: their moments to the chunks from `chunk` on, then g as what
  /// they hand to u. u: displacements before, null where nothing is seen from elsewhere.
  void nodes_back(Exec const& exec, List<Exec, Vec3> const& x, Vec3 const* u, int f, Index chunk,
                  List<Exec, Vec3> const& g) const {
    kernels::launch("gridmorph::transposed::common::nodes", exec,
                    kernels::CommonMoments<Memory>{frame, x, {}, g.data(), u, of(f), 1, partial.data() + chunk});
    kernels::launch("gridmorph::transposed::common::pull", exec, 0, Index(g.extent(0)),
                    kernels::PullCommonGradient<false>{of(f), g.data()});
  }
  /// Last: what the rest hands back becomes what it hands to the displacement that is given, and `to` has added what
  /// the fit hands there. n_chunks: of all that came before.
  void fit_back(Exec const& exec, Index n_chunks, Vec3 const* rest, int f, int of_gradients,
                List<Exec, Vec3> const& of_rest, List<Exec, Vec3> const& to) const {
    kernels::launch("gridmorph::transposed::common::pull", exec, 0, Index(of_rest.extent(0)),
                    kernels::PullCommonGradient<true>{of(f), of_rest.data()});
    kernels::CommonMoments<Memory> const moments{frame, position, {}, of_rest.data(),
                                                 rest,  of(f),    -1, partial.data() + n_chunks};
    kernels::launch("gridmorph::transposed::common::rest", exec, moments);
    sum<false>(exec, n_chunks + moments.size(), false, of_gradients);
    kernels::launch("gridmorph::transposed::common::fit", exec,
                    kernels::CommonMotionBack<Memory>{frame, position, weight, of(of_gradients), to.data()});
  }

 private:
  static std::string name(char const* what) { return std::string("gridmorph::CommonMotion::") + what; }

  template <bool Adds>
  void sum(Exec const& exec, Index n_chunks, bool pull, int to) const {
    kernels::launch(
        "gridmorph::common::sum", exec,
        kernels::SumCommonMoments<Adds>{frame, partial.data(), n_chunks, projection.data(), pull, move.data() + to});
  }
};

}  // namespace gridmorph::stages
