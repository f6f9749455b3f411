// Tables that side files of structured and unstructured meshes share. Internal to casefile.
#pragma once

#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::casefile {

/// Words for `kind`, in the order of PatchKind.
extern std::vector<std::string> const side_file_kinds;
/// The CGNS type that a kind stands for; empty where there is none.
std::string bc_type_of(PatchKind kind);

/// [[periodic]]: transforms by name.
class SidePeriodics {
 public:
  void read(TableReader& table);
  /// The one that the key `periodic` of another table names; nothing, and a problem, where there is none of that name.
  std::optional<Periodic> of(TableReader& table) const;

 private:
  std::map<std::string, Periodic> all_;
};

/// Adds to a mesh of elements what its side file says.
void read_side_file_of_elements(Context& context, toml::value const& document, Mesh& mesh);

}  // namespace gridmorph::casefile
