// Which passes need a barrier before them: every order of two accesses, with and without a barrier in between.

#include <gtest/gtest.h>

#include "vulkan/recorder.h"

namespace gnomon {
namespace {

struct Case {
    Access first, second;
    bool needsBarrier;
};

constexpr Case kCases[] = {
    {Access::Read, Access::Read, false},       {Access::Read, Access::Indirect, false},
    {Access::Read, Access::Write, true},       {Access::Write, Access::Read, true},
    {Access::Write, Access::Write, true},      {Access::Write, Access::Indirect, true},
    {Access::Indirect, Access::Write, true},   {Access::Indirect, Access::Read, false},
    {Access::Streamed, Access::Read, false},   {Access::Uniform, Access::Uniform, false},
    {Access::Write, Access::Streamed, false},  // streamed buffers are the host's alone: no pass writes them
    {Access::Sampled, Access::Sampled, false},
};

TEST(BarrierTracker, AsksForABarrierWhereOneOfTwoAccessesWrites) {
    for (const Case& c : kCases) {
        SCOPED_TRACE(testing::Message() << "access " << int(c.first) << " then " << int(c.second));
        BarrierTracker tracker;
        BarrierTracker::Use use;
        EXPECT_FALSE(tracker.conflicts(use, c.first)) << "nothing came before";
        tracker.note(use, c.first);
        EXPECT_EQ(tracker.conflicts(use, c.second), c.needsBarrier);
        tracker.barrier();
        EXPECT_FALSE(tracker.conflicts(use, c.second)) << "a barrier came between";
    }
}

TEST(BarrierTracker, OneBarrierOrdersAllBuffers) {
    BarrierTracker tracker;
    BarrierTracker::Use lists, counts;
    tracker.note(lists, Access::Write);
    tracker.note(counts, Access::Write);
    tracker.barrier();
    EXPECT_FALSE(tracker.conflicts(lists, Access::Read));
    EXPECT_FALSE(tracker.conflicts(counts, Access::Write));
}

TEST(BarrierTracker, AWriteAfterABarrierCountsAgain) {
    BarrierTracker tracker;
    BarrierTracker::Use use;
    tracker.note(use, Access::Write);
    tracker.barrier();
    tracker.note(use, Access::Write);
    EXPECT_TRUE(tracker.conflicts(use, Access::Read));
    EXPECT_TRUE(tracker.conflicts(use, Access::Indirect));
}

}  // namespace
}  // namespace gnomon
