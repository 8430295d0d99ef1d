// Hierarchical depth and phases 2 and 3 against the oracle.
#include <gtest/gtest.h>

#include "checks.h"
#include "scenes.h"

namespace gnomon::test {
namespace {

class ListsTest : public GpuTest {};
GNOMON_ON_EVERY_DEVICE(ListsTest);

constexpr ListReservation kReservations[] = {ListReservation::Approximate, ListReservation::Accurate,
                                             ListReservation::Fixed};

TEST_P(ListsTest, DepthAndLightsOfARoom) {
    const FrameInput input = makeRoomFrame({});
    for (const ListReservation reservation : kReservations) {
        SCOPED_TRACE(int(reservation));
        Rig rig(device(), {.reservation = reservation, .fixedEntries = 50}, viewDescFor(input));
        ASSERT_TRUE(rig.ok());
        const Checked checked = checkFrame(input, rig.run(input));
        EXPECT_GT(checked.early.must, 200u);
        EXPECT_LT(checked.early.mayShare(), 0.01);
        EXPECT_LT(checked.approximate.surplusShare(), 0.5);
        std::printf("  must %zu may %zu surplus %.3f\n", checked.early.must, checked.early.may,
                    checked.approximate.surplusShare());
    }
}

}  // namespace
}  // namespace gnomon::test
