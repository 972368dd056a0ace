#include "core/node_binding.h"

#include <cstddef>

namespace etendue {

NodeBinding::NodeBinding(int slots, std::span<const ProcessorSet> nodes) : everywhere_(ProcessorSet::of_this_thread()) {
    const auto processors = static_cast<std::size_t>(size_of_all(nodes));
    std::size_t dealt = 0;
    for (const ProcessorSet& node : nodes) {
        dealt += static_cast<std::size_t>(node.size());
        node_of_slot_.resize(static_cast<std::size_t>(slots) * dealt / processors, node);
    }
}

NodeBinding::Stay::Stay(const NodeBinding& binding, int slot) : binding_(binding) {
    if (!binding_.node_of_slot_.empty()) binding_.node_of_slot_[static_cast<std::size_t>(slot)].bind_this_thread();
}

NodeBinding::Stay::~Stay() {
    if (!binding_.node_of_slot_.empty()) binding_.everywhere_.bind_this_thread();
}

}  // namespace etendue
