// Whoever looks on while a batch works.
#pragma once

#include "report/batch_report.h"

namespace etendue {

/// Gets the state of a batch from time to time.
class BatchWatcher {
  public:
    BatchWatcher() = default;
    BatchWatcher(const BatchWatcher&) = delete;
    BatchWatcher& operator=(const BatchWatcher&) = delete;
    virtual ~BatchWatcher() = default;

    /// Says whether somebody waits for the state.
    [[nodiscard]] virtual bool wants_report() const = 0;
    /// Called with the state as it is, and at the end with the last one.
    virtual void show(const BatchReport& report) = 0;
};

}  // namespace etendue
