#include "common/runtime/sleeper.hpp"

namespace limbcast::runtime {

// The event is only ever closed, so a wait that ends early means "stopped".
bool Sleeper::Until(Time deadline) { return !event_.WaitUntil(deadline); }

bool Sleeper::For(Duration span) { return !event_.WaitFor(span); }

}  // namespace limbcast::runtime
