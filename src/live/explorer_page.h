// The page of a scene to look around in.
#pragma once

#include "live/explorer.h"
#include "live/live_server.h"

#include <atomic>
#include <string>

namespace etendue {

/// Shows an explorer to a browser while it lives; the explorer must outlive it.
class ExplorerPage {
  public:
    /// Listens on `port`, or on a free one if that is 0, and says where on stderr. Throws IoError if it cannot.
    ExplorerPage(int port, Explorer& explorer);

    /// Returns true once the page has been asked to end.
    [[nodiscard]] bool is_ended() const { return is_ended_; }

  private:
    [[nodiscard]] std::string status() const;
    [[nodiscard]] LiveAnswer answer(const LiveRequest& request);
    [[nodiscard]] LiveAnswer follow(const LiveRequest& request);

    Explorer& explorer_;
    std::atomic<bool> is_ended_{false};
    LiveServer server_;  ///< last: it answers from the others
};

}  // namespace etendue
