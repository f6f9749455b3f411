#include <generators/text_file.hpp>
#include <gridmorph/core/error.hpp>

#include <fstream>
#include <system_error>

namespace gridmorph {

void make_folder(std::filesystem::path const& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw MachineError("folder '" + folder.string() + "' cannot be made: " + error.message());
}

void write_text_file(std::filesystem::path const& path, std::string const& text, std::string const& what) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file)
    throw MachineError(what + " '" + path.string() + "' cannot be written; is the disk full or the folder read-only?");
}

}  // namespace gridmorph
