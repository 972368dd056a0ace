#include "core/node_binding.h"

#include <cstddef>

namespace etendue {

NodeBinding::NodeBinding(int slots, std::span<const ProcessorSet> nodes) {
    const auto processors = static_cast<std::size_t>(size_of_all(nodes));
    std::size_t dealt = 0;
    for (const ProcessorSet& node : nodes) {
        dealt += static_cast<std::size_t>(node.size());
        node_of_slot_.resize(static_cast<std::size_t>(slots) * dealt / processors, node);
    }
}

NodeBinding::Stay::Stay(const NodeBinding& binding, int slot) {
    if (binding.node_of_slot_.empty()) return;
    const ProcessorSet before = ProcessorSet::of_this_thread();
    if (binding.node_of_slot_[static_cast<std::size_t>(slot)].bind_this_thread()) before_ = before;
}

NodeBinding::Stay::~Stay() {
    if (before_) before_->bind_this_thread();
}

}  // namespace etendue
