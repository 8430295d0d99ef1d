#pragma once
// A folder of its own for each test, removed afterwards.

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>

namespace gnomon::renderer {

class PictureFiles : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("gnomon_picture_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
};

inline std::size_t filesIn(const std::filesystem::path& folder) {
    using Files = std::filesystem::directory_iterator;
    return static_cast<std::size_t>(std::distance(Files(folder), Files()));
}

}  // namespace gnomon::renderer
