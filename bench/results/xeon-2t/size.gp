# Draws size.png: gnuplot size.gp
if (!exists('ending')) ending = ''
if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {
    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'
} else {
    set terminal png size 1100,700
}
set encoding utf8
set datafile missing 'nan'
set grid linetype 1 linecolor '#c8c8c8' linewidth 1
set border linecolor '#404040'
set key outside right top Left reverse noenhanced
set tics nomirror
set format y '%g'
set style line 1 linecolor '#0072B2' linewidth 2 pointtype 7 pointsize 2.2
set style line 2 linecolor '#D55E00' linewidth 2 pointtype 5 pointsize 1.7
set output 'size.png'.ending
set title 'What a particle-step costs on meshes of growing size'
set key outside top center horizontal
set xlabel 'triangles'
set ylabel 'ns'
set logscale x
set format x '10^{%L}'
set yrange [0:*]
$numbers << EOD
20 31.2588 75.4424
320 34.924 84.5827
5120 36.2921 100.546
20480 40.2401 111.082
79380 43.6858 125.506
317520 47.8541 130.507
1.3005e+06 56.2036 126.338
4.94018e+06 62.0268 131.768
9.88418e+06 57.6623 125.175
EOD
plot $numbers using 1:2 with linespoints linestyle 1 title 'ricochet: a step of a particle', \
     $numbers using 1:3 with linespoints linestyle 2 title 'bare ray'
set output
