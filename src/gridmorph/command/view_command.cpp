// view: pictures of meshes, and a page of them.
#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/made_folders.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/png.hpp>
#include <gridmorph/run/view.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

namespace {

/// A mesh that is named as a picture stays where it is.
void check_pictures(CommandLine const& options) {
  Problems problems;
  for (auto const& mesh : {std::optional(options.input), options.second})
    if (mesh && mesh->extension() == ".png" &&
        io::identity_of(mesh->has_parent_path() ? mesh->parent_path() : ".") == io::identity_of(*options.output))
      problems.add(
          fmt::format("view '{}': lies in the folder of the pictures and is named as one, and inputs are never "
                      "overwritten; give another folder, --out FOLDER",
                      mesh->string()));
  problems.throw_if_any<ConfigError>();
}

void check_box(ViewRequest const& request) {
  if (!request.box) return;
  auto const& b = *request.box;
  if (!(b[0] < b[1] && b[2] < b[3] && std::isfinite(b[1] - b[0]) && std::isfinite(b[3] - b[2])))
    throw ConfigError(fmt::format("--box {} {} {} {}: give X0 below X1 and Y0 below Y1", b[0], b[1], b[2], b[3]));
}

}  // namespace

int run_view_command(CommandLine const& options, Terminal& terminal) {
  check_pictures(options);
  check_box(options.view);
  ViewRequest request = options.view;
  request.mesh = options.input;
  request.morphed = options.second;
  page::ViewPage const page = draw_view(request, terminal);
  terminal.progress("writing " + options.output->string());
  io::MadeFolders made(*options.output);
  io::OutputFiles files;
  std::vector<std::string> pictures;
  for (auto const* figures : {&page.figures, &page.stages})
    for (page::ViewFigure const& figure : *figures) {
      pictures.push_back((*options.output / figure.file).string());
      files.add(pictures.back()).write(io::png_bytes(figure.picture));
    }
  std::string const document_page = (*options.output / "view.html").string();
  files.add(document_page).write(view_page_text(page));
  files.commit();
  made.keep();
  for (std::string const& picture : pictures) terminal.say(picture + '\n');
  terminal.say(document_page + '\n');
  nlohmann::json document{{"gridmorph", GRIDMORPH_VERSION},
                          {"baseline", options.input.string()},
                          {"pictures", pictures},
                          {"page", document_page}};
  if (options.second) document["morphed"] = options.second->string();
  terminal.document(document);
  return done;
}

}  // namespace gridmorph::cli
