// The one translation unit that holds volk, the Vulkan meta-loader.
#define VOLK_IMPLEMENTATION
#include <volk.h>
