#pragma once

namespace terrane {

/// Threads of OpenMP that wait for each other look for a moment and then sleep, so that on a busy
/// machine they leave the processor to the thread they wait for. As OpenMP reads how to wait when
/// it is loaded, the program starts itself once more with that in its environment, before it has
/// done anything; not where the user has said how to wait, nor for commands that compute nothing.
void wait_without_spinning(int argc, char** argv);

}  // namespace terrane
