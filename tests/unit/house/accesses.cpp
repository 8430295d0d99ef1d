// Problem: whether a shader writes a buffer. The words "readonly" in its source tell only where they stand; the passes
// of the library share one declaration of their sets, which leaves them out.
// Here: every pointer is followed from its variable through the instructions that make pointers of pointers, to the
// loads, stores and atomics at its end. Shaders are compiled with all calls inlined, so no pointer is lost.
// Source: SPIR-V specification 1.5, sections 2.3 and 3.32.
#include "unit/house/accesses.h"

#include <span>
#include <stdexcept>

namespace gnomon::house {
namespace {

enum Op : std::uint32_t {
    kFunctionCall = 57,
    kVariable = 59,
    kImageTexelPointer = 60,
    kLoad = 61,
    kStore = 62,
    kCopyMemory = 63,
    kAccessChain = 65,
    kInBoundsAccessChain = 66,
    kArrayLength = 68,
    kCopyObject = 83,
    kSelect = 169,
    kAtomicLoad = 227,
    kAtomicStore = 228,
    kAtomicExchange = 229,
    kAtomicXor = 242,
    kPhi = 245,
};
constexpr std::uint32_t kStorageClassFunction = 7;
constexpr std::size_t kHeadWords = 5;

class Follower {
public:
    explicit Follower(std::string name) : name_(std::move(name)) {}

    // `op`: the words of one instruction.
    void take(std::uint32_t code, std::span<const std::uint32_t> op) {
        switch (code) {
            case kVariable:
                if (op[3] != kStorageClassFunction) variableOf_[op[2]] = op[2];
                return;
            case kAccessChain:
            case kInBoundsAccessChain:
            case kCopyObject:
                if (variableOf_.contains(op[3])) variableOf_[op[2]] = variableOf_[op[3]];
                return;
            case kLoad:
            case kArrayLength:
            case kAtomicLoad:
                return note(op[3], true, false);
            case kStore:
            case kAtomicStore:
                return note(op[1], false, true);
            case kCopyMemory:
                note(op[1], false, true);
                return note(op[2], true, false);
            default:
                break;
        }
        if (code >= kAtomicExchange && code <= kAtomicXor) return note(op[3], true, true);
        refusePointers(code, op);
    }

    [[nodiscard]] const std::map<std::uint32_t, ShaderAccess>& accesses() const { return accesses_; }

private:
    void note(std::uint32_t pointer, bool read, bool written) {
        const auto found = variableOf_.find(pointer);
        if (found == variableOf_.end()) return;  // local to a function
        ShaderAccess& access = accesses_[found->second];
        access.read = access.read || read;
        access.written = access.written || written;
    }

    void refusePointers(std::uint32_t code, std::span<const std::uint32_t> op) const {
        if (code != kFunctionCall && code != kImageTexelPointer && code != kSelect && code != kPhi) return;
        for (const std::uint32_t word : op.subspan(3)) {
            if (!variableOf_.contains(word)) continue;
            throw std::runtime_error(name_ + ": a resource's pointer is used by instruction " + std::to_string(code) +
                                     ", which is not followed");
        }
    }

    std::string name_;
    std::map<std::uint32_t, std::uint32_t> variableOf_;  // by the id of a pointer
    std::map<std::uint32_t, ShaderAccess> accesses_;
};

}  // namespace

std::map<std::uint32_t, ShaderAccess> accessesOf(const std::vector<std::uint32_t>& words, const std::string& name) {
    Follower follower(name);
    const std::span<const std::uint32_t> all(words);
    for (std::size_t i = kHeadWords; i < all.size();) {
        const std::size_t length = all[i] >> 16;
        if (length == 0 || length > all.size() - i) throw std::runtime_error(name + " ends within an instruction");
        follower.take(all[i] & 0xFFFFu, all.subspan(i, length));
        i += length;
    }
    return follower.accesses();
}

}  // namespace gnomon::house
