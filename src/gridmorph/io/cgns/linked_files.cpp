#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/cgns/linked_files.hpp>
#include <gridmorph/io/file_check.hpp>

#include <set>

namespace gridmorph {

namespace {

void collect(cgns::Node const& node, std::set<std::string>& files) {
  if (!node.file.empty()) files.insert(node.file);
  for (auto const& child : node.children) collect(child, files);
}

}  // namespace

std::vector<std::string> linked_files(std::string const& path) {
  std::set<std::string> files;
  if (cgns::is_cgns(path)) collect(cgns::File(path, cgns::File::Mode::read).tree(), files);
  return {files.begin(), files.end()};
}

}  // namespace gridmorph
