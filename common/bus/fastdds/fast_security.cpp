#include "common/bus/fastdds/fast_security.hpp"

#include <fastrtps/config.h>

#include <string>

#include "common/security/credentials.hpp"

namespace limbcast::bus::fastdds {

Status AddSecurity(const BusConfig& config, eprosima::fastdds::dds::DomainParticipantQos& qos) {
  if (config.security_dir.empty()) {
    return Ok();
  }
#if HAVE_SECURITY
  const security::CredentialFiles files =
      security::FilesOf(config.security_dir, config.security_role, security::Library::kFast);
  auto& properties = qos.properties().properties();
  const auto set = [&](const std::string& name, const std::string& value) {
    properties.emplace_back("dds.sec." + name, value);
  };
  const auto set_file = [&](const std::string& name, const std::filesystem::path& file) {
    set(name, "file://" + file.string());
  };
  set("auth.plugin", "builtin.PKI-DH");
  set("access.plugin", "builtin.Access-Permissions");
  set("crypto.plugin", "builtin.AES-GCM-GMAC");
  set_file("auth.builtin.PKI-DH.identity_ca", files.authority);
  set_file("auth.builtin.PKI-DH.identity_certificate", files.certificate);
  set_file("auth.builtin.PKI-DH.private_key", files.key);
  set_file("access.builtin.Access-Permissions.permissions_ca", files.authority);
  set_file("access.builtin.Access-Permissions.governance", files.governance);
  set_file("access.builtin.Access-Permissions.permissions", files.permissions);
  return Ok();
#else
  (void)qos;
  return Error{ErrorCode::kUnsupported, "security: this Fast DDS was built without security"};
#endif
}

}  // namespace limbcast::bus::fastdds
