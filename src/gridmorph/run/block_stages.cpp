#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/morph/stage_by_stage.hpp>
#include <gridmorph/report/json_text.hpp>
#include <gridmorph/run/block_stages.hpp>
#include <gridmorph/run/console.hpp>
#include <gridmorph/run/output_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <utility>

namespace gridmorph::cli {

namespace {

/// "stage_02_iteration_1.cgns"
std::string file_name(int number, std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return fmt::format("stage_{:02}_{}.cgns", number, name);
}

bool differ(Coordinates const& a, Coordinates const& b) {
  for (Index n = 0; n < a.size(); ++n)
    if (!(a[n] == b[n])) return true;
  return false;
}

class StageWriter {
 public:
  StageWriter(std::filesystem::path folder, Mesh const& mesh, Plan const& plan)
      : folder_(std::move(folder)), mesh_(mesh), plan_(plan) {
    StagesOfCells const cells = stages_of_cells(mesh, plan);
    fields_.displacement = true;
    for (auto const& [name, values] :
         {std::pair("Stage", &cells.stage), std::pair("Chain", &cells.chain), std::pair("Direction", &cells.direction)})
      fields_.cells.push_back({name, std::vector<double>(values->begin(), values->end())});
  }

  void write(std::string const& name, Coordinates const& positions) {
    std::string const file = file_name(int(list_.size()), name);
    write_mesh((folder_ / file).string(), mesh_, positions, fields_);
    written_.insert(file);
    nlohmann::json chains = nlohmann::json::array();
    if (std::size_t const n = list_.size(); n >= 1 && n <= plan_.stages.size())
      chains = plan_.stages[n - 1].description;
    list_.push_back({{"number", list_.size()}, {"name", name}, {"file", file}, {"chains", std::move(chains)}});
  }

  void finish() const {
    PendingFile list(folder_ / stage_list_name, json_text({{"stages", list_}}));
    list.commit();
    std::vector<std::filesystem::path> others;
    for (auto const& entry : std::filesystem::directory_iterator(folder_))
      if (is_stage_of_blocks(entry.path()) && !written_.contains(entry.path().filename().string()))
        others.push_back(entry.path());
    for (auto const& other : others) std::filesystem::remove(other);
  }

 private:
  std::filesystem::path folder_;
  Mesh const& mesh_;
  Plan const& plan_;
  OutputFields fields_;
  nlohmann::json list_ = nlohmann::json::array();
  std::set<std::string> written_;
};

}  // namespace

bool is_stage_of_blocks(std::filesystem::path const& path) {
  std::string const name = path.filename().string();
  return name.starts_with("stage_") && name.ends_with(".cgns") && name.size() > 8 &&
         std::isdigit(static_cast<unsigned char>(name[6])) != 0 &&
         std::isdigit(static_cast<unsigned char>(name[7])) != 0;
}

void make_stage_folder(std::filesystem::path const& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw MachineError(
        fmt::format("the folder '{}' for the stages cannot be made: {}", folder.string(), error.message()));
}

void write_block_stages(std::filesystem::path const& folder, Mesh const& mesh, Plan const& plan,
                        std::span<Vec3 const> displacement, Coordinates const& morphed) {
  make_stage_folder(folder);
  StageWriter writer(folder, mesh, plan);
  bool guarded = false;
  morph_stage_by_stage(plan, mesh.coordinates, displacement, [&](StagesDone const& done, Coordinates const& positions) {
    writer.write(done.name, positions);
    guarded = differ(positions, morphed);
  });
  if (guarded) writer.write("guard", morphed);
  writer.finish();
}

}  // namespace gridmorph::cli
