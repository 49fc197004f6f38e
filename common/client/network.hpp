#pragma once

#include <memory>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/client/client_options.hpp"

namespace limbcast::client {

/// Joins the network of `options`, in the partition of its session when it has one. Fails with
/// kInvalidArgument (an option), kUnavailable (the network refuses), or as
/// security::CheckCredentials.
[[nodiscard]] Result<std::unique_ptr<bus::Bus>> OpenNetwork(const ClientOptions& options);

/// Whether `options` allow nothing to be published: spectators of a secured network.
[[nodiscard]] bool OnlyListens(const ClientOptions& options);

}  // namespace limbcast::client
