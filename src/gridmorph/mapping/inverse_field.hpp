// A displacement taken back: from where nodes are to where a field, known at the place before it, brings them from.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <functional>
#include <mutex>
#include <span>
#include <string>

namespace gridmorph {

/// How well X + u(X) = x holds.
struct InverseReport {
  Index evaluated = 0;       ///< positions x
  int iterations = 0;        ///< most that one of them took
  double residual = 0;       ///< largest |X + u(X) - x| [length]
  double one_step = 0;       ///< the same of X = x - u(x), the first order [length]
  Vec3 worst_of_one_step{};  ///< where that is
  Index held = 0;            ///< positions whose iterations went to and fro between elements, and were held on one
  /// How much u differs at these positions from one element to the next, where no place has a residual within the
  /// tolerance [length].
  double jump = 0;
};

/// Finds X with X + s u(X) = x for every position by itself: X_0 = x, X_{k+1} = x - s u(X_k), until the residual
/// |X_k + s u(X_k) - x| is at most the tolerance. No system is solved. It contracts where s u changes by less than the
/// distance does
/// (|s du/dx| < 1), by that rate per iteration. Evaluations may come from several threads.
///
/// Fields of elements jump where these meet at an angle, off their surface, and iterations may go to and fro between
/// the two sides for ever. Where the residual does not get smaller any more, u is held on the element of one iterate
/// after the other; the first X whose residual is within the tolerance without holding is taken, and that with the
/// smallest jump, at most a hundredth of the largest displacement of the call, where there is none: x lies in a gap
/// that the field itself leaves.
class InverseField {
 public:
  /// Evaluates u at places; `iterates`: these are no nodes, and no report counts them.
  using Field = std::function<void(std::span<Vec3 const> places, std::span<Vec3> displacement, bool iterates)>;

  /// Evaluates u at places, each by the element, or the points, that its anchor, a place nearby, is mapped from.
  using HeldField =
      std::function<void(std::span<Vec3 const> places, std::span<Vec3 const> anchors, std::span<Vec3> displacement)>;

  /// Inverts to within a tolerance, > 0 [length]. source: for messages.
  InverseField(std::string source, double tolerance, int most_iterations);

  /// displacement[n] = X - x for x = points[n]. Equal points get equal results. Throws MotionError naming a position
  /// and its residual where that does not get smaller over eight iterations, or is above the tolerance after the last.
  /// Cost: an evaluation of u per iteration. `held`: none for fields without jumps.
  void operator()(Field const& u, double share, std::span<Vec3 const> points, std::span<Vec3> displacement,
                  HeldField const& held = {}) const;

  [[nodiscard]] InverseReport report() const;
  [[nodiscard]] double tolerance() const { return tolerance_; }

 private:
  /// Throws the error about a place whose iterations do not end. `earlier`: the residual eight iterations before, where
  /// it did not get smaller.
  [[noreturn]] void refuse(Vec3 const& x, double residual, int iterations, double earlier) const;

  std::string source_;
  double tolerance_;
  int most_;
  mutable std::mutex turn_;
  mutable InverseReport report_;
};

}  // namespace gridmorph
