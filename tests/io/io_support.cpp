#include "io_support.hpp"

#include <cgns_io.h>

namespace gridmorph::test {

namespace {

void dump(int file, double id, std::string const& path, std::map<std::string, std::string>& out) {
  int children = 0;
  if (cgio_number_children(file, id, &children) != 0) throw std::runtime_error("cannot list " + path);
  std::vector<double> ids(std::max(children, 1));
  int found = 0;
  if (children > 0) cgio_children_ids(file, id, 1, children, &found, ids.data());
  for (int c = 0; c < found; ++c) {
    char name[64] = "", label[64] = "", type[8] = "";
    cgio_get_name(file, ids[c], name);
    cgio_get_label(file, ids[c], label);
    cgio_get_data_type(file, ids[c], type);
    int rank = 0;
    cgsize_t dimensions[12] = {};
    cgio_get_dimensions(file, ids[c], &rank, dimensions);
    std::string text = std::string(label) + "|" + type;
    std::size_t bytes = type[1] == '8' ? 8 : type[1] == '4' ? 4 : 1;
    for (int d = 0; d < rank; ++d) {
      text += "|" + std::to_string(dimensions[d]);
      bytes *= std::size_t(dimensions[d]);
    }
    text += "\n";
    if (rank > 0 && std::string(type) != "MT") {
      std::string data(bytes, '\0');
      if (cgio_read_all_data_type(file, ids[c], type, data.data()) != 0)
        throw std::runtime_error("cannot read " + path + "/" + name);
      text += data;
    }
    std::string const child = path + "/" + name;
    out[child] = text;
    dump(file, ids[c], child, out);
  }
}

}  // namespace

std::map<std::string, std::string> dump_tree(std::string const& path) {
  int file = 0;
  if (cgio_open_file(path.c_str(), CGIO_MODE_READ, CGIO_FILE_NONE, &file) != 0)
    throw std::runtime_error("cannot open " + path);
  double root = 0;
  cgio_get_root_id(file, &root);
  std::map<std::string, std::string> out;
  dump(file, root, "", out);
  cgio_close_file(file);
  return out;
}

}  // namespace gridmorph::test
