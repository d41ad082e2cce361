// Sample for the layering test: a public header of a layer to the right of sh.
