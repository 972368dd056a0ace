// Threads that stay on the memory node of the slot in which they work.
#pragma once

#include "core/memory_nodes.h"

#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Deals the slots of a thread pool to memory nodes, in their order and in proportion to their processors.
class NodeBinding {
  public:
    /// Leaves every thread where it is.
    NodeBinding() = default;

    /// @param slots at least one
    /// @param nodes at least one, none empty
    NodeBinding(int slots, std::span<const ProcessorSet> nodes);

    /// While it lives, the calling thread runs on the processors of its slot's node; afterwards wherever it did before.
    class Stay {
      public:
        Stay(const NodeBinding& binding, int slot);
        ~Stay();
        Stay(const Stay&) = delete;
        Stay& operator=(const Stay&) = delete;

      private:
        std::optional<ProcessorSet> before_;  ///< if it is bound
    };

  private:
    std::vector<ProcessorSet> node_of_slot_;  ///< none where nobody is bound
};

}  // namespace etendue
