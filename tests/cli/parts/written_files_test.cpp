// SPDX-License-Identifier: BSD-3-Clause
//
// Several files that are written all together or not at all, and outputs through symbolic links.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "io/base/text.hpp"
#include "output/output.hpp"
#include "tegl/io/text.hpp"

namespace tegl::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

// The path of a temporary PendingPath would be of a removed file.
template <class File>
concept HasPath = requires(File&& file) {
  std::forward<File>(file).path();
};
static_assert(HasPath<PendingPath&> && HasPath<const PendingPath&> && !HasPath<PendingPath>);

class WrittenFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("written_files_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
  static void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string text(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.insert(entry.path().filename().string());
    return all;
  }
  void write(WrittenFiles& written, const std::string& name, const std::string& content) const {
    written.write(path(name), [&](const PendingPath& file) { write_text(content, file); });
  }

  fs::path folder_;
};

TEST_F(WrittenFilesTest, AppearTogetherAtTheEnd) {
  put(path("old.csv"), "old");
  {
    WrittenFiles written;
    write(written, "old.csv", "new");
    write(written, "other.csv", "other");
    EXPECT_EQ(text(path("old.csv")), "old");
    EXPECT_FALSE(fs::exists(path("other.csv")));
    written.keep();
    EXPECT_EQ(text(path("old.csv")), "new");
  }
  EXPECT_THAT(names(), UnorderedElementsAre("old.csv", "other.csv"));
}

TEST_F(WrittenFilesTest, ThatAreNotKeptLeaveNothing) {
  put(path("old.csv"), "old");
  {
    WrittenFiles written;
    write(written, "old.csv", "new");
    write(written, "other.csv", "other");
  }
  EXPECT_THAT(names(), UnorderedElementsAre("old.csv"));
  EXPECT_EQ(text(path("old.csv")), "old");
}

TEST_F(WrittenFilesTest, GoBackIfOneOfThemCannotBePutInPlace) {
  put(path("a.csv"), "old");
  {
    WrittenFiles written;
    write(written, "a.csv", "new");
    write(written, "b.csv", "new");
    write(written, "c.csv", "new");
    fs::create_directories(path("c.csv") / "in the way");
    try {
      written.keep();
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::WriteFailed);
      EXPECT_THAT(error.what(), HasSubstr(path("c.csv").string()));
    }
    EXPECT_EQ(text(path("a.csv")), "old");
  }
  EXPECT_THAT(names(), UnorderedElementsAre("a.csv", "c.csv"));
  EXPECT_EQ(text(path("a.csv")), "old");
}

TEST_F(WrittenFilesTest, AreAFileEachByWhateverName) {
  fs::create_directories(path("folder"));
  fs::create_symlink("a.csv", path("link.csv"));  // its target does not exist yet
  fs::create_directory_symlink(folder_, path("folder/back"));
  for (const std::string other : {"a.csv", "./a.csv", "folder/../a.csv", "link.csv", "folder/back/a.csv"}) {
    WrittenFiles written;
    write(written, "a.csv", "first");
    try {
      write(written, other, "second");
      ADD_FAILURE() << "no error: " << other;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_THAT(error.what(), HasSubstr("expected a file for each result"));
    }
    EXPECT_THROW(require_different_outputs({path("a.csv").string(), path(other).string()}), Error) << other;
  }
  EXPECT_NO_THROW(require_different_outputs({path("a.csv").string(), path("folder/a.csv").string()}));
  EXPECT_THAT(names(), UnorderedElementsAre("folder", "link.csv"));
}

TEST_F(WrittenFilesTest, AreWrittenThroughLinks) {
  fs::create_directories(path("folder"));
  put(path("there.csv"), "old");
  fs::create_symlink("there.csv", path("to_there.csv"));
  fs::create_symlink("folder/not_yet.csv", path("to_not_yet.csv"));
  fs::create_symlink("to_not_yet.csv", path("to_link.csv"));
  write_text("one", path("to_there.csv"));
  write_text("two", path("to_link.csv"));
  for (const char* const link : {"to_there.csv", "to_not_yet.csv", "to_link.csv"})
    EXPECT_TRUE(fs::is_symlink(path(link))) << link;
  EXPECT_EQ(text(path("there.csv")), "one");
  EXPECT_EQ(text(path("folder/not_yet.csv")), "two");
  fs::create_symlink("round.csv", path("round.csv"));
  EXPECT_THROW(write_text("three", path("round.csv")), Error);
  EXPECT_TRUE(fs::is_symlink(path("round.csv")));
}

TEST_F(WrittenFilesTest, KeepThePermissionsOfWhatWasThere) {
  const auto mode = [&](const fs::path& file) {
    struct stat found {};
    EXPECT_EQ(stat(file.c_str(), &found), 0);
    return found.st_mode & 0777U;
  };
  const mode_t before = umask(022);
  for (const char* const name : {"private.csv", "several.csv", "shared.csv"}) put(path(name), "old");
  ASSERT_EQ(chmod(path("private.csv").c_str(), 0600), 0);
  ASSERT_EQ(chmod(path("several.csv").c_str(), 0600), 0);
  ASSERT_EQ(chmod(path("shared.csv").c_str(), 0666), 0);
  write_text("new", path("private.csv"));
  write_text("new", path("shared.csv"));
  WrittenFiles written;
  written.write(path("several.csv"), [&](const PendingPath& file) {
    write_text("new", file);
    EXPECT_EQ(mode(file.path()), 0600U) << "not only in the end";
  });
  write(written, "fresh.csv", "new");
  written.keep();
  umask(before);
  EXPECT_EQ(mode(path("private.csv")), 0600U);
  EXPECT_EQ(mode(path("several.csv")), 0600U);
  EXPECT_EQ(mode(path("shared.csv")), 0666U);
  EXPECT_EQ(mode(path("fresh.csv")), 0644U);
}

}  // namespace
}  // namespace tegl::cli
