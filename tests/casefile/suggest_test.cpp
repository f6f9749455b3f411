#include <gridmorph/core/suggest.hpp>

#include <gtest/gtest.h>

namespace gridmorph {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsSubstitutionsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("input", "input"), 0);
  EXPECT_EQ(edit_distance("inptu", "input"), 1);
  EXPECT_EQ(edit_distance("inpt", "input"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(EditDistance, IsSymmetric) {
  for (auto const& [a, b] : {std::pair{"patches", "patch"}, {"rule", "ruler"}, {"tolerance", "torelance"}})
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
}

TEST(Suggestion, NamesTheNearestWord) {
  std::vector<std::string> const known{"fixed", "rigid", "circumferential-slide", "follow"};
  EXPECT_EQ(nearest_word("rigit", known), "rigid");
  EXPECT_EQ(nearest_word("circumferential_slide", known), "circumferential-slide");
  EXPECT_EQ(nearest_word("Fixed", known), "fixed");
  EXPECT_EQ(nearest_word("circumferential", known), "circumferential-slide");
  EXPECT_EQ(nearest_word("translation", known), "");
  EXPECT_EQ(suggestion("folow", known), "; did you mean 'follow'?");
}

TEST(Suggestion, ListsWhatIsKnownWhenNothingIsNear) {
  EXPECT_EQ(suggestion("zzz", {"alpha", "beta"}), "; known here: alpha, beta");
  EXPECT_EQ(suggestion("dq", {"r", "x", "y"}), "; known here: r, x, y");
  EXPECT_EQ(suggestion("zzz", {}), "");
}

}  // namespace
}  // namespace gridmorph
