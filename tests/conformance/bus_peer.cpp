// The writing side of a conformance test as a process of its own: one command a line on stdin, one
// reply a line on stdout (peer_session.hpp has the commands). Ends with stdin or with its parent.

#include <sys/prctl.h>

#include <csignal>
#include <iostream>
#include <string>

#include "tests/conformance/peer_session.hpp"

int main() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that dies leaves no process behind
  limbcast::conformance::PeerSession session;
  for (std::string line; std::getline(std::cin, line);) {
    std::cout << session.Do(line) << std::endl;
  }
  return 0;
}
