// Buses that a test in another process commands: lines in, lines out (secure_session.hpp).
#include <iostream>
#include <string>

#include "tests/system/security/secure_session.hpp"

int main() {
  limbcast::security_test::SecureSession session;
  for (std::string line; std::getline(std::cin, line);) {
    std::cout << session.Do(line) << std::endl;
  }
  return 0;
}
