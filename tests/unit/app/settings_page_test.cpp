// docs/settings.md is what `gnomon settings` prints, to the byte: a setting that is added, renamed or explained anew
// cannot be forgotten there. To write the page: gnomon settings > docs/settings.md
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "unit/app/program.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// The first line that differs, both ways; empty where none does.
std::string firstDifference(const std::string& page, const std::string& printed) {
    if (page == printed) return {};
    std::istringstream a(page), b(printed);
    std::string inPage, inPrint;
    for (int line = 1;; ++line) {
        const bool more = static_cast<bool>(std::getline(a, inPage));
        const bool morePrinted = static_cast<bool>(std::getline(b, inPrint));
        if (more && morePrinted && inPage == inPrint) continue;
        if (!more && !morePrinted) return "they differ in the end of the last line";
        return "line " + std::to_string(line) + ": the page has '" + (more ? inPage : "nothing") +
               "', the program prints '" + (morePrinted ? inPrint : "nothing") + "'";
    }
}

TEST(SettingsPage, IsWhatTheProgramPrints) {
    const fs::path folder = fs::path(testing::TempDir()) / "gnomon_app_settings_page";
    fs::create_directories(folder);
    const Outcome printed = runProgram(folder, "settings");
    fs::remove_all(folder);
    ASSERT_EQ(printed.exitCode, 0) << printed.err;
    ASSERT_NE(printed.out, "");
    EXPECT_EQ(firstDifference(read(fs::path(GNOMON_SOURCE_DIR) / "docs/settings.md"), printed.out), "");
}

TEST(SettingsPage, DifferencesAreTold) {
    EXPECT_EQ(firstDifference("a\nb\n", "a\nb\n"), "");
    EXPECT_EQ(firstDifference("a\nb\n", "a\nc\n"), "line 2: the page has 'b', the program prints 'c'");
    EXPECT_EQ(firstDifference("a\n", "a\nc\n"), "line 2: the page has 'nothing', the program prints 'c'");
    EXPECT_EQ(firstDifference("a\nb\n", "a\n"), "line 2: the page has 'b', the program prints 'nothing'");
    EXPECT_EQ(firstDifference("a", "a\n"), "they differ in the end of the last line");
    EXPECT_NE(firstDifference("", "a\n"), "");
}

}  // namespace
}  // namespace gnomon::app
