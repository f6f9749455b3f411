// A displacement made of several: a mean, load cases with factors, and mode shapes that oscillate with amplitude,
// frequency and phase.
#pragma once

#include <gridmorph/mapping/point_field.hpp>

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph {

/// One mode shape, f real or f + i g complex.
struct Mode {
  StructuralModel model;   ///< nodes with f (displacement) and, of a complex mode, g (imaginary)
  double amplitude = 1;    ///< times the shape of the file
  double harmonic = 1;     ///< cycles per period
  double phase_turns = 0;  ///< of a full turn: 0.25 is 90 degrees
};

/// u(t) = mean + sum_j factor_j f_j + sum_k amplitude_k (cos(a_k) f_k - sin(a_k) g_k), a_k = 2 pi (harmonic_k t +
/// phase_turns_k), t in periods: load cases j (speed, temperature, pressure), and of modes k the real part of (f + i g)
/// exp(i a).
///
/// Modes and load cases on equal nodes and elements share one mapping, and stencils are kept: after the first time
/// every further one costs O(nodes of the models) plus a lookup and some twenty multiply-adds per position. Elements
/// turn with the sum of the modes on them. Memory: about 400 bytes per position. Evaluations may come from several
/// threads.
class ModalField {
 public:
  /// Throws ConfigError as PointField does.
  ModalField(std::optional<StructuralModel> mean, std::vector<Mode> modes, std::vector<StructuralModel> loads,
             FieldOptions options);
  ModalField(std::optional<StructuralModel> mean, std::vector<Mode> modes, FieldOptions options)
      : ModalField(std::move(mean), std::move(modes), {}, options) {}

  /// Displacement at `periods` (time over period), one factor per load case; `iterates` as in PointField::evaluate.
  /// Throws MotionError as PointField does.
  void at(double periods, std::span<double const> factors, std::span<Vec3 const> points, std::span<Vec3> displacement,
          bool iterates = false) const;
  /// The sum of PointField::held() over the models.
  void held(double periods, std::span<double const> factors, std::span<Vec3 const> points,
            std::span<Vec3 const> anchors, std::span<Vec3> displacement) const;
  void at(double periods, std::span<Vec3 const> points, std::span<Vec3> displacement) const {
    at(periods, {}, points, displacement);
  }

  /// The fields, one per different model, for reports.
  [[nodiscard]] std::vector<std::shared_ptr<PointField const>> const& fields() const { return fields_; }
  [[nodiscard]] std::size_t n_modes() const { return modes_.size(); }
  [[nodiscard]] std::size_t n_loads() const { return loads_.size(); }

 private:
  struct Part {
    std::size_t field = 0;  ///< in fields_
    std::size_t real = 0;   ///< field number of f there
    std::size_t imaginary = 0;
    bool complex = false;
    double amplitude = 1, harmonic = 0, phase_turns = 0;
  };
  /// The factors of every field of every model at that time.
  [[nodiscard]] std::vector<std::vector<double>> factors_at(double periods, std::span<double const> loads) const;

  std::vector<std::shared_ptr<PointField const>> fields_;
  std::vector<Part> modes_;
  std::vector<Part> loads_;
  std::optional<Part> mean_;
};

/// Cosine and sine of `turns` full turns; exactly 0, 1 and -1 at whole quarters.
struct Oscillation {
  double cosine, sine;
};
Oscillation oscillation(double turns);

}  // namespace gridmorph
