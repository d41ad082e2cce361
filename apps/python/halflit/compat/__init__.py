"""Interfaces of other packages over halflit. Each module is imported by its own name: import halflit.compat.pyrender as pyrender."""
