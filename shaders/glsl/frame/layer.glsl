// The layer that a vertex is drawn into.

// With LAYERS_ONE_BY_ONE, on some software devices, it cannot be chosen here: Context::render draws each by itself.
void choose_layer(int layer) {
#ifndef LAYERS_ONE_BY_ONE
  gl_Layer = layer;
#endif
}
