// Which chain has which law.
#pragma once

#include <gridmorph/plan/blocks/stage_builder.hpp>
#include <gridmorph/plan/law_table.hpp>
#include <gridmorph/plan/options.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// The laws of the options, with the patches that they name looked up in a mesh and tables of those that are the user's
/// own.
class ChainLaws {
 public:
  /// A law of the options.
  struct Choice {
    Law law = Law::linear;
    int own = -1;  ///< which of the user's own
    friend bool operator==(Choice const&, Choice const&) = default;
  };
  /// The end of a chain from which a law starts. either: where nothing tells one from the other a law of the user's own
  /// counts by its part that is the same from both, (w(t) + 1 - w(1 - t)) / 2.
  enum class From { first, last, either };
  struct OfChain {
    Choice choice;
    From from = From::either;
  };

  /// Throws PlanError for laws of the user's own that tabulate() refuses, and for ends that are neither kinds nor
  /// patches.
  ChainLaws(Mesh const& mesh, VolumeOptions const& options);

  /// Which ends of laws name a patch (or, after the patches, an interface); block faces hold patches that are alike in
  /// this.
  [[nodiscard]] std::vector<char> naming(int patch) const;

  [[nodiscard]] Choice usual() const { return usual_; }
  /// The law of a chain by its ends; `given` before all. A law between two ends starts from the first of them, all
  /// others from the end that ranks better in `kind_order`.
  [[nodiscard]] OfChain of(Chain const& chain, std::optional<Law> given,
                           std::vector<std::string> const& kind_order) const;
  /// The law along a chain from the first end of which it starts, or from either. near: of the two ends, those on the
  /// edge of a near field, which moves as one with its wall: slope zero there.
  [[nodiscard]] ChainLaw along(OfChain const& law, std::array<bool, 2> const& near) const;
  [[nodiscard]] std::string name(Choice const& choice) const;

  /// The knots of all laws of the user's own.
  [[nodiscard]] std::vector<double> const& knots() const { return knots_; }
  [[nodiscard]] std::vector<std::string> const& notes() const { return notes_; }

 private:
  /// What names an end of a law: a kind, or patches.
  struct End {
    std::string kind;
    std::vector<int> patches;  ///< as Known::patches

    [[nodiscard]] bool fits(ChainEnd const& end) const;
  };
  struct BetweenEnds {
    std::array<End, 2> end;
    Choice choice;
  };

  Choice choice_of(Law law, OwnLaw const& own);
  std::array<std::int32_t, 2> keep(LawTable const& table);

  Choice usual_;
  double linear_share_;
  std::vector<BetweenEnds> between_;
  /// ChainLaw::knots of laws of the user's own, and of what is the same from both ends.
  std::vector<std::array<std::array<std::int32_t, 2>, 2>> tables_;
  std::vector<std::string> own_names_, notes_;
  std::vector<double> knots_;
};

}  // namespace gridmorph
