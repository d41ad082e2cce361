# Wrapped lobes compared
# A figure of the literature, made anew: the lobes without and with the factor that keeps a surface's light the same.
halflit figures normalized --format png -o figures
