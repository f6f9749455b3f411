// Several outputs at once, and outputs in the place of what was read.
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/read_file.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

TEST(OutputFiles, WhereOneCannotBePutInPlaceTheOthersComeBackAsTheyWere) {
  TemporaryFolder const folder;
  folder.write("old", "before");
  {
    io::OutputFiles files;
    files.add(folder.file("old")).write("after");
    files.add(folder.file("new")).write("after");
    files.add(folder.file("last")).write("after");
    std::filesystem::create_directory(folder / "last");  // in between
    EXPECT_THROW(files.commit(), Error);
  }
  EXPECT_EQ(io::read_file(folder.file("old")), "before");
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
  EXPECT_EQ(folder.names().size(), 2U) << "nothing else is left";
}

TEST(OutputFiles, AllAreThereInTheEndAndNothingElse) {
  TemporaryFolder const folder;
  folder.write("old", "before");
  {
    io::OutputFiles files;
    files.add(folder.file("old")).write("after");
    files.add(folder.file("new")).write("after");
    files.commit();
  }
  EXPECT_EQ(io::read_file(folder.file("old")), "after");
  EXPECT_EQ(io::read_file(folder.file("new")), "after");
  EXPECT_EQ(folder.names().size(), 2U);
}

TEST(FilesRead, NoOutputTakesThePlaceOfAFileThatWasReadWhileSomebodyKeepsTheList) {
  TemporaryFolder const folder;
  folder.write("mesh", "bytes");
  std::filesystem::create_hard_link(folder / "mesh", folder / "hard");
  std::filesystem::create_symlink("mesh", folder / "soft");
  (void)io::read_file(folder.file("mesh"));
  io::OutputFile(folder.file("mesh")).commit();  // nobody has asked: the library leaves that to its callers
  folder.write("mesh", "bytes");
  std::filesystem::remove(folder / "hard");
  std::filesystem::create_hard_link(folder / "mesh", folder / "hard");
  io::FilesRead const list;
  (void)io::read_file(folder.file("mesh"));
  for (char const* name : {"mesh", "hard", "soft"})
    expect_all_in(message_of<IoError>([&] { io::OutputFile(folder.file(name)).commit(); }), {"never overwritten"});
  EXPECT_EQ(io::read_file(folder.file("mesh")), "bytes");
  io::OutputFile(folder.file("other")).commit();
  io::FilesRead::release(folder / "mesh");
  io::OutputFile(folder.file("mesh")).commit();
}

}  // namespace
}  // namespace gridmorph::test
