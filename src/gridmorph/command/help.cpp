#include <gridmorph/command/help.hpp>
#include <gridmorph/command/own_files.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace gridmorph::cli {

namespace {

struct Topic {
  std::string_view command;
  std::string_view examples;
  std::string_view pages;  ///< of the docs
};

constexpr std::array topics{
    Topic{"gridmorph",
          "  gridmorph inspect wing.cgns --suggest case.toml    a case file to start from; edit one rule in it\n"
          "  gridmorph morph case.toml                          the mesh moved as it says\n"
          "  gridmorph demo passage                             a mesh of our own, morphed\n",
          "README.md, case_file.md, formats.md, examples.md"},
    Topic{"morph",
          "  gridmorph morph case.toml --report report.json\n"
          "  gridmorph morph case.toml --output bent.su2 --dry-run\n",
          "case_file.md (every key), motion.md (the rules), unstructured.md, quality.md (the table and the report)"},
    Topic{"inspect",
          "  gridmorph inspect wing.cgns\n"
          "  gridmorph inspect cascade.su2 --suggest case.toml\n"
          "  gridmorph inspect grid.p3d --write-side-file grid.toml\n",
          "formats.md (CGNS, PLOT3D and SU2 files, side files)"},
    Topic{"plan", "  gridmorph plan case.toml\n  gridmorph plan case.toml --graph plan.svg\n",
          "method.md (stages and chains), unstructured.md"},
    Topic{"certify", "  gridmorph certify case.toml\n  gridmorph certify case.toml --limit 4 --report box.json\n",
          "quality.md#a-box-of-designs, case_file.md#parameters"},
    Topic{"quality",
          "  gridmorph quality wing.cgns wing_morphed.cgns\n"
          "  gridmorph quality cascade.su2 --json\n",
          "quality.md (what is measured, and how)"},
    Topic{"wheel", "  gridmorph wheel case.toml --output wheel.cgns\n", "wheel.md, case_file.md#wheel"},
    Topic{"fillet", "  gridmorph fillet passage.cgns --blade blade --wall hub --radius 0.004 --output filled.cgns\n",
          "root_fillet.md"},
    Topic{"blocks", "  gridmorph blocks cavity.msh --output blocks.cgns\n", "unstructured.md#blocks-in-hexahedra"},
    Topic{"hexahedra", "  gridmorph hexahedra passage.cgns --output elements.cgns\n",
          "unstructured.md#the-same-mesh-both-ways, formats.md"},
    Topic{"surface", "  gridmorph surface wing.cgns --patches type:wall --output wing.stl\n",
          "motion.md#target (what the surface is for), formats.md"},
    Topic{"view",
          "  gridmorph view passage.cgns passage_rotation.cgns --out pictures\n"
          "  gridmorph view wing.cgns wing_morphed.cgns --out pictures --plane y=3.5\n",
          "demo_passage.md, demo_ball.md (what is drawn), report.md (pages of morphs, with pictures)"},
    Topic{"keys", "  gridmorph keys guard\n  gridmorph keys rigid --json\n",
          "case_file.md (the same and more, with examples)"},
    Topic{"demo",
          "  gridmorph demo passage --nodes 1000000\n"
          "  gridmorph demo ball --elements 200000 --angle 20\n",
          "demo_passage.md, demo_ball.md"}};

Topic const* topic_of(CLI::App const* app) {
  auto const found =
      std::find_if(topics.begin(), topics.end(), [&](Topic const& t) { return t.command == app->get_name(); });
  return found == topics.end() ? nullptr : &*found;
}

/// Where the docs are: beside the installed program, or in the source tree that it was built in; "docs" where they are
/// nowhere.
std::string docs_folder() {
  constexpr std::array<std::string_view, 2> names{"share/doc/gridmorph/docs", "docs"};
  return own_folder(names, "case_file.md").value_or("docs").string();
}

}  // namespace

HelpFormatter::HelpFormatter() { column_width(34); }

std::string HelpFormatter::make_description(CLI::App const* app) const {
  auto const* topic = topic_of(app);
  std::string const examples = topic ? "Examples:\n" + std::string(topic->examples) + "\n" : "";
  return examples + CLI::Formatter::make_description(app);
}

std::string HelpFormatter::make_footer(CLI::App const* app) const {
  auto const* topic = topic_of(app);
  return CLI::Formatter::make_footer(app) +
         (topic ? "Docs: " + std::string(topic->pages) + "\n      in " + docs_folder() + "; man gridmorph\n" : "");
}

}  // namespace gridmorph::cli
