// Threads that stay on the memory node of the slot in which they work.
#pragma once

#include "core/memory_nodes.h"

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

    /// While it lives, the calling thread runs on the processors of its slot's node. Afterwards it may run wherever the
    /// maker of the binding might, not where it might before: a worker inherits that from the thread that happened to
    /// start it, which can be one that is bound.
    class Stay {
      public:
        /// @param binding outlives this
        Stay(const NodeBinding& binding, int slot);
        ~Stay();
        Stay(const Stay&) = delete;
        Stay& operator=(const Stay&) = delete;

      private:
        const NodeBinding& binding_;
    };

  private:
    std::vector<ProcessorSet> node_of_slot_;  ///< none where nobody is bound
    ProcessorSet everywhere_;
};

}  // namespace etendue
