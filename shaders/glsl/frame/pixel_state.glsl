// What a camera pixel is to a light, before any shadow map is asked.
const int PIXEL_BACKGROUND = 0;  // no geometry: lit
const int PIXEL_AWAY = 1;        // the geometric normal faces away from the light: in shadow, whatever the map says
const int PIXEL_OUTSIDE = 2;     // outside the map or the light's range: lit, the light's own falloff decides
const int PIXEL_INSIDE = 3;      // the map decides
const int PIXEL_OTHERS = 4;      // another view of the light sees it

// Of pixels that no map decides about.
float unmapped_visibility(int state) { return state == PIXEL_AWAY ? 0.0 : 1.0; }
