#include "ricochet/collision/signed_distance.h"
