//! Files in: Mitsuba XML, OBJ, PLY
