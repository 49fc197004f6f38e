#include "common/bus/cyclone/cyclone_security.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <system_error>

#include "common/security/credentials.hpp"

// Where CMake found the plugins; empty in a build against a library without them.
#ifndef LIMBCAST_PLUGIN_AUTH
#define LIMBCAST_PLUGIN_AUTH ""
#endif
#ifndef LIMBCAST_PLUGIN_AC
#define LIMBCAST_PLUGIN_AC ""
#endif
#ifndef LIMBCAST_PLUGIN_CRYPTO
#define LIMBCAST_PLUGIN_CRYPTO ""
#endif

namespace limbcast::bus::cyclone {
namespace {

struct Plugin {
  const char* prefix;  // of its properties
  const char* function;
  const char* path;
};
constexpr std::array<Plugin, 3> kPlugins = {
    {{"dds.sec.auth.library.", "authentication", LIMBCAST_PLUGIN_AUTH},
     {"dds.sec.access.library.", "access_control", LIMBCAST_PLUGIN_AC},
     {"dds.sec.crypto.library.", "crypto", LIMBCAST_PLUGIN_CRYPTO}}};

void Set(dds_qos_t* qos, const std::string& name, const std::string& value) {
  dds_qset_prop(qos, name.c_str(), value.c_str());
}

void SetFile(dds_qos_t* qos, const std::string& name, const std::filesystem::path& file) {
  Set(qos, "dds.sec." + name, "file:" + file.string());
}

}  // namespace

Status AddSecurity(const BusConfig& config, dds_qos_t* qos) {
  if (config.security_dir.empty()) {
    return Ok();
  }
  for (const Plugin& plugin : kPlugins) {
    std::error_code ignored;
    if (!std::filesystem::exists(plugin.path, ignored)) {
      return Error{ErrorCode::kUnsupported,
                   std::string("security: this Cyclone DDS has no plugin for ") + plugin.function +
                       " (" + (*plugin.path == '\0' ? "built without" : plugin.path) + ")"};
    }
    Set(qos, std::string(plugin.prefix) + "path", plugin.path);
    Set(qos, std::string(plugin.prefix) + "init", std::string("init_") + plugin.function);
    Set(qos, std::string(plugin.prefix) + "finalize", std::string("finalize_") + plugin.function);
  }
  const security::CredentialFiles files =
      security::FilesOf(config.security_dir, config.security_role, security::Library::kCyclone);
  SetFile(qos, "auth.identity_ca", files.authority);
  SetFile(qos, "auth.identity_certificate", files.certificate);
  SetFile(qos, "auth.private_key", files.key);
  SetFile(qos, "access.permissions_ca", files.authority);
  SetFile(qos, "access.governance", files.governance);
  SetFile(qos, "access.permissions", files.permissions);
  return Ok();
}

}  // namespace limbcast::bus::cyclone
