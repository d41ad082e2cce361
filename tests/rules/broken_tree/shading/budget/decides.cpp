// A decision by the C library.
bool cheap(double error) { return std::exp(error) < 2.0; }
