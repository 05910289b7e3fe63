"""What runs inside ParaView's programmable filters.

The text of these modules travels in the filters, and so in state files, which open without this
folder (see `terrane_view.scripts`). They use numpy and VTK alone.
"""
