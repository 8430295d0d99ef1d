#pragma once
// What the tests of the renderer's parts share: one instance with validation, and the devices that can run them.

#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "renderer/gpu/device.h"
#include "renderer/gpu/instance.h"

namespace gnomon::renderer {

class DeviceTest : public ::testing::Test {
protected:
    static VulkanInstance& instance() {
        static VulkanInstance shared({.validation = true});
        return shared;
    }
    static std::vector<DeviceInfo> suitable() {
        std::vector<DeviceInfo> out;
        for (const DeviceInfo& d : instance().listDevices()) {
            if (d.suitable)
                out.push_back(d);
            else
                std::printf("skipped: %s\n", d.missing.c_str());
        }
        return out;
    }
    static void expectNoMessages() {
        EXPECT_EQ(instance().messages().count(), 0u);
        instance().messages().clear();
    }
};

}  // namespace gnomon::renderer
