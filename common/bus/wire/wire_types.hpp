#pragma once

// Every generated type. Included by the codecs and the DDS back ends only.
#include <limbcast/wire/geometry.h>
#include <limbcast/wire/health.h>
#include <limbcast/wire/posture.h>
#include <limbcast/wire/segment.h>
#include <limbcast/wire/sensor.h>
#include <limbcast/wire/session.h>
