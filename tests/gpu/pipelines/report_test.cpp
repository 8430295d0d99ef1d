// bench/pipeline_report on RADV's null device: every pipeline is in the table, in both widths, with registers.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <regex>
#include <string>

namespace gnomon {
namespace {

std::string outputOf(const char* command, int& status) {
    std::string out;
    std::FILE* pipe = popen(command, "r");
    char chunk[4096];
    while (const std::size_t n = std::fread(chunk, 1, sizeof(chunk), pipe)) out.append(chunk, n);
    status = pclose(pipe);
    return out;
}

// VGPRs by "pipeline lanes".
std::map<std::string, int> registersIn(const std::string& table) {
    std::map<std::string, int> out;
    const std::regex row(R"(\n\| ([a-z][^|]*[a-z0-9)]) \| (\d+) \| (\d+) \|)");
    for (std::sregex_iterator i(table.begin(), table.end(), row), end; i != end; ++i)
        EXPECT_TRUE(out.emplace((*i)[1].str() + " " + (*i)[2].str(), std::stoi((*i)[3].str())).second) << i->str();
    return out;
}

TEST(PipelineReport, HasEveryPipelineInBothWidths) {
    if (std::getenv("RADV_FORCE_FAMILY") == nullptr) GTEST_SKIP() << "skipped: only with RADV_FORCE_FAMILY";
    int status = -1;
    const std::string table = outputOf("'" GNOMON_PIPELINE_REPORT "'", status);
    EXPECT_EQ(status, 0);
    std::map<std::string, int> registers = registersIn(table);
    std::size_t expected = 0;
    for (const char* lanes : {" 32", " 64"}) {
        const auto expectRow = [&](const std::string& name) {
            EXPECT_GT(registers[name + lanes], 0) << name << lanes;
            ++expected;
        };
        for (const char* once : {"hierarchical_depth", "find_lights_approximate",
                                 "find_lights_approximate, lists by pixel", "find_lights_accurate", "shadow_bounds",
                                 "classify_pairs", "gather_statistics", "lighting_deferred", "lighting_unshadowed"})
            expectRow(once);
        for (const char* shadowing : {"lighting_evaluate", "lighting_inline", "lighting_inline, lists alone"})
            for (const char* provider :
                 {"hard", "pcf, radius 1", "pcf, radius 3", "pcss", "pcss-shared", "hard, pcf and both pcss"})
                expectRow(std::string(shadowing) + " (" + provider + ")");
        for (const char* provider : {"hard", "pcf, radius 1", "pcf, radius 3", "hard, pcf and both pcss"})
            expectRow(std::string("filter_tiles (") + provider + ")");
        for (const char* queued :
             {"search_pairs (pcss-shared, ", "filter_pairs (pcss, ", "filter_pairs (pcss-shared, "})
            for (const char* kind : {"one view", "six faces", "cascades"}) expectRow(std::string(queued) + kind + ")");
    }
    EXPECT_EQ(registers.size(), expected) << table;
}

}  // namespace
}  // namespace gnomon
