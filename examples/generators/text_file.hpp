// Folders and text files of the demos. Internal to them.
#pragma once

#include <filesystem>
#include <string>

namespace gridmorph {

/// Makes a folder if it is missing, with those above it. Throws MachineError.
void make_folder(std::filesystem::path const& folder);

/// Writes a file; `what` names it in messages: "case file". Throws MachineError.
void write_text_file(std::filesystem::path const& path, std::string const& text, std::string const& what);

}  // namespace gridmorph
