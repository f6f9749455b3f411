// Text on pages: names of any kind come out as text.
#include <gridmorph/page/html.hpp>
#include <gridmorph/page/report_page.hpp>
#include <gridmorph/report/quality_json.hpp>

#include <gtest/gtest.h>

#include <string>

namespace gridmorph::page {
namespace {

TEST(Html, EscapesWhatHasAMeaning) {
  EXPECT_EQ(escaped("<script>alert('1 & \"2\"')</script>"),
            "&lt;script&gt;alert(&#39;1 &amp; &quot;2&quot;&#39;)&lt;/script&gt;");
  EXPECT_EQ(escaped("blade \u00e9\u4e2d\U0001F600\n\tx"), "blade \u00e9\u4e2d\U0001F600\n\tx");
}

TEST(Html, ReplacesWhatIsNoText) {
  std::string const sign = "\uFFFD";
  EXPECT_EQ(escaped(std::string("a\0b\x07", 4)), "a" + sign + "b" + sign);
  EXPECT_EQ(escaped("\xff\xc3"), sign + sign);
  EXPECT_EQ(escaped("\xc0\xaf"), sign + sign);                        // overlong
  EXPECT_EQ(escaped("\xed\xa0\x80"), sign + sign + sign);             // a surrogate
  EXPECT_EQ(escaped("\xf4\x90\x80\x80"), sign + sign + sign + sign);  // beyond Unicode
  EXPECT_EQ(escaped("\xe4\xb8"), sign + sign);                        // cut off
}

constexpr char const* hostile = "</style><script>alert(1)</script>\"'&";

/// A page with that name everywhere.
ReportPage page_of(std::string const& name) {
  QualityReport quality;
  quality.zone_names = {name};
  quality.against_baseline = true;
  quality.near_field.cells = 3;
  for (auto& m : quality.near_field.measure) m = {0.5, 0.75, 1, 0, {1, 2, 3}, 0.5};
  quality.wall_groups = {{name, {}}};
  quality.certificate = Certificate{3, 0, 0, 1, 0, {1, 0, {1, 2, 3}, -1, 0}};
  ReportPage page;
  page.report = quality_json(quality, quality, {});
  page.report.update(
      {{"gridmorph", name},
       {"case_file", name},
       {"input", name},
       {"output", name},
       {"nodes", 8},
       {"notes", {name}},
       {"fields", nlohmann::json::array()},
       {"stages", nlohmann::json::array()},
       {"times",
        {{"steps", {{{"step", name}, {"seconds", 1.0}, {"nodes_per_second", nullptr}}}}, {"total_seconds", 1.0}}}});
  page.plan = {{"stages", {{{"name", name}, {"chains", {name}}, {"cells", 3}}}}};
  page.kind = "cells";
  page.mesh_size = 1;
  page.mesh_summary = name;
  page.rules = {{name, name, name, 4, 0.5, 0.25}};
  page.worst = {{{name, {1, 2, 3}}, name, {}, {}, {}, {}}};
  page.sections = {{name, {{"<img alt=\"\">", name}}}};
  page.surfaces = {{"<img alt=\"\">", name}};
  page.settings = {{name, name}};
  page.command_line = page.case_text = page.histogram_note = name;
  return page;
}

TEST(Html, ShowsHostileNamesAsText) {
  std::string const text = page_text(page_of(hostile));
  EXPECT_EQ(text.find("<script>alert"), std::string::npos);
  EXPECT_EQ(text.find("\"'&"), std::string::npos);
  EXPECT_NE(text.find(escaped(hostile)), std::string::npos);
  std::string const harmless = page_text(page_of("name"));
  auto const count = [](std::string const& in, std::string const& what) {
    std::size_t n = 0;
    for (std::size_t at = in.find(what); at != std::string::npos; at = in.find(what, at + 1)) ++n;
    return n;
  };
  for (std::string const tag : {"<", ">", "<script", "</style"})
    EXPECT_EQ(count(text, tag), count(harmless, tag)) << tag;
}

TEST(Html, SaysTheVerdictFirst) {
  ReportPage page = page_of("name");
  page.report["morphed"]["certificate"]["broken"]["cells"] = 0;
  page.report["morphed"]["certificate"]["holds"] = true;
  page.report["shortfalls"] = nlohmann::json::array();
  auto const verdict = [&] {
    std::string const text = page_text(page);
    std::size_t const at = text.find("<section");
    return text.substr(at, text.find("</h2>") - at);
  };
  EXPECT_NE(verdict().find("Valid"), std::string::npos);
  EXPECT_EQ(page_text(page).find("were flat in the baseline"), std::string::npos);
  page.report["morphed"]["certificate"]["flat_before"] = 90;
  EXPECT_NE(page_text(page).find("90 that are negative by little were flat in the baseline"), std::string::npos);
  EXPECT_NE(verdict().find("Valid"), std::string::npos);
  page.report["shortfalls"].push_back({{"severity", "failure"}, {"message", "small"}});
  EXPECT_NE(verdict().find("short of the thresholds"), std::string::npos);
  page.report["morphed"]["far_field"]["newly_inverted"] = 2;
  EXPECT_NE(verdict().find("Inverted"), std::string::npos);
}

}  // namespace
}  // namespace gridmorph::page
