#include <gridmorph/mapping/modal_field.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace gridmorph {

namespace {

bool same_nodes(StructuralModel const& a, StructuralModel const& b) {
  return a.nodes.position == b.nodes.position &&
         std::equal(a.facets.begin(), a.facets.end(), b.facets.begin(), b.facets.end(),
                    [](StructuralFacet const& f, StructuralFacet const& g) { return f.node == g.node; });
}

/// A model and the fields of all modes on its nodes.
struct Group {
  StructuralModel model;
  std::vector<std::vector<Vec3>> further;
};

/// The sum over fields of what evaluate(f, displacement) makes of each.
template <class Evaluate>
void sum_over(std::size_t fields, std::span<Vec3> displacement, Evaluate const& evaluate) {
  std::fill(displacement.begin(), displacement.end(), Vec3{0, 0, 0});
  std::vector<Vec3> one(displacement.size());
  for (std::size_t f = 0; f < fields; ++f) {
    evaluate(f, std::span<Vec3>(one));
    for (std::size_t n = 0; n < one.size(); ++n) displacement[n] += one[n];
  }
}

}  // namespace

Oscillation oscillation(double turns) {
  double const quarter = std::nearbyint(4 * turns);
  double const rest = 2 * std::numbers::pi * (turns - quarter / 4);
  double const c = std::cos(rest), s = std::sin(rest);
  switch (int(std::fmod(quarter, 4)) & 3) {
    case 0: return {c, s};
    case 1: return {-s, c};
    case 2: return {-c, -s};
    default: return {s, -c};
  }
}

ModalField::ModalField(std::optional<StructuralModel> mean, std::vector<Mode> modes, std::vector<StructuralModel> loads,
                       FieldOptions options) {
  options.keep = true;
  std::vector<Group> groups;
  // Number of the field that a displacement becomes; the first one of a group is that of its model.
  auto const add = [](Group& group, std::vector<Vec3> field) {
    group.further.push_back(std::move(field));
    return group.further.size();
  };
  auto const place = [&](StructuralModel model) {
    Part part;
    auto const known =
        std::find_if(groups.begin(), groups.end(), [&](Group const& g) { return same_nodes(g.model, model); });
    part.field = std::size_t(known - groups.begin());
    part.complex = !model.nodes.imaginary.empty();
    std::vector<Vec3> imaginary = std::move(model.nodes.imaginary);
    if (known == groups.end())
      groups.push_back({std::move(model), {}});
    else
      part.real = add(*known, std::move(model.nodes.displacement));
    if (part.complex) part.imaginary = add(groups[part.field], std::move(imaginary));
    return part;
  };
  if (mean) mean_ = place(std::move(*mean));
  for (Mode& mode : modes) {
    Part part = place(std::move(mode.model));
    part.amplitude = mode.amplitude;
    part.harmonic = mode.harmonic;
    part.phase_turns = mode.phase_turns;
    modes_.push_back(part);
  }
  for (StructuralModel& load : loads) loads_.push_back(place(std::move(load)));
  for (Group& group : groups)
    fields_.push_back(std::make_shared<PointField const>(std::move(group.model), options, std::move(group.further)));
}

std::vector<std::vector<double>> ModalField::factors_at(double periods, std::span<double const> load_factors) const {
  std::vector<std::vector<double>> factors;
  for (auto const& field : fields_) factors.emplace_back(field->n_fields(), 0.0);
  if (mean_) factors[mean_->field][mean_->real] = 1;
  for (std::size_t l = 0; l < loads_.size(); ++l) factors[loads_[l].field][loads_[l].real] = load_factors[l];
  for (Part const& part : modes_) {
    auto const [cosine, sine] = oscillation(part.harmonic * periods + part.phase_turns);
    factors[part.field][part.real] = part.amplitude * cosine;
    if (part.complex) factors[part.field][part.imaginary] = -part.amplitude * sine;
  }
  return factors;
}

void ModalField::held(double periods, std::span<double const> load_factors, std::span<Vec3 const> points,
                      std::span<Vec3 const> anchors, std::span<Vec3> displacement) const {
  auto const factors = factors_at(periods, load_factors);
  sum_over(fields_.size(), displacement,
           [&](std::size_t f, std::span<Vec3> one) { fields_[f]->held(factors[f], points, anchors, one); });
}

void ModalField::at(double periods, std::span<double const> load_factors, std::span<Vec3 const> points,
                    std::span<Vec3> displacement, bool iterates) const {
  auto const factors = factors_at(periods, load_factors);
  sum_over(fields_.size(), displacement,
           [&](std::size_t f, std::span<Vec3> one) { fields_[f]->evaluate(factors[f], points, one, iterates); });
}

}  // namespace gridmorph
