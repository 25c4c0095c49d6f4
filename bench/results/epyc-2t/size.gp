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
20 17.9963 47.5234
320 18.0276 47.9448
5120 19.2739 52.9741
20480 20.9181 53.7916
79380 22.1988 63.6167
317520 26.6156 73.8559
1.3005e+06 31.7163 76.7731
4.94018e+06 46.4612 89.8962
9.88418e+06 44.2125 82.4957
EOD
plot $numbers using 1:2 with linespoints linestyle 1 title 'ricochet: a step of a particle', \
     $numbers using 1:3 with linespoints linestyle 2 title 'bare ray'
set output
